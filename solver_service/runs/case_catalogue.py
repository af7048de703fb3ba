"""The cases that a service offers: a name in a message is looked up here and never used as a path."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager

from protocol import CaseSummary
from solver_service.errors import RunError, ServiceError
from solver_service.scenario import case_summary, list_cases

LOG = logging.getLogger(__name__)


class CaseCatalogue:
    """Offered cases by name."""

    def __init__(self, extra: tuple[str, ...] = ()) -> None:
        """Look at what is there.

        Args:
            extra: names or paths that the operator offers beside the known cases.

        Raises:
            CaseError: one of the extra cases cannot be read.
        """
        self._names: dict[str, str] = {}
        self._sources: dict[str, str] = {}
        self._summaries: dict[str, CaseSummary] = {}
        self._starting: Counter[str] = Counter()
        for source in list_cases():
            try:
                self._add(source)
            except ServiceError as error:  # one bad case does not keep the others from being served
                LOG.warning("case %s is not offered: %s", source, error)
        for source in extra:
            self._add(source)

    def _add(self, source: str) -> None:
        summary = case_summary(source)
        self._names[source] = summary.name
        self.add(summary, source)

    def add(self, summary: CaseSummary, source: str) -> None:
        """Offer a case, in place of one of the same name.

        Args:
            summary: the case in a few words.
            source: what `load_case` is to be given.
        """
        self._sources[summary.name] = source
        self._summaries[summary.name] = summary

    def remove(self, name: str) -> None:
        """Offer a case no longer.

        Raises:
            RunError: it is not offered, or a run of it is being started.
        """
        self.source(name)
        if self._starting[name]:
            raise RunError(f"a run of case {name} is being started; try again")
        del self._sources[name], self._summaries[name]

    @contextmanager
    def held(self, name: str) -> Iterator[str]:
        """Keep a case on offer until the block ends; gives what `load_case` is to be given.

        Raises:
            RunError: the case is not offered.
        """
        source = self.source(name)
        self._starting[name] += 1
        try:
            yield source
        finally:
            self._starting[name] -= 1

    @property
    def summaries(self) -> tuple[CaseSummary, ...]:
        """All cases by name."""
        return tuple(self._summaries[name] for name in sorted(self._summaries))

    def find(self, case: str) -> CaseSummary | None:
        """A case in a few words, by its name or by the path that the operator gave."""
        return self._summaries.get(self.name(case))

    def name(self, case: str) -> str:
        """The name of a case asked for by its name or by the path that the operator gave."""
        return self._names.get(case, case)

    def source(self, name: str) -> str:
        """What `load_case` is to be given for a name.

        Raises:
            RunError: the case is not offered.
        """
        if name not in self._sources:
            raise RunError(
                f"there is no case {name!r}; there are {', '.join(sorted(self._sources)) or 'none'}"
            )
        return self._sources[name]
