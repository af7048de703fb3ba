"""The cases that a service offers: a name in a message is looked up here and never used as a path."""

from __future__ import annotations

import logging

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
        self._sources[summary.name] = source
        self._summaries[summary.name] = summary

    @property
    def summaries(self) -> tuple[CaseSummary, ...]:
        """All cases by name."""
        return tuple(self._summaries[name] for name in sorted(self._summaries))

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
