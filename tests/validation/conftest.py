"""Fixtures ``figure``, ``compare`` and ``picture``: measure, assert, and keep numbers and diagrams for the
documents."""

from collections.abc import Callable, Collection

import pytest

from tests.validation.figures import FIGURES, Figure
from tests.validation.pictures import PICTURES, Panel, Picture
from tests.validation.runs import State, errors

UNITS = {"h": "m", "discharge": "m2/s", "velocity": "m/s"}


def pytest_configure(config: pytest.Config) -> None:
    config.stash.setdefault(FIGURES, [])
    config.stash.setdefault(PICTURES, [])


@pytest.fixture
def figure(request: pytest.FixtureRequest) -> Callable[..., Figure]:
    """Record one number and assert its bounds: ``figure(case, quantity, value, below=..., ...)``."""

    def record(case: str, quantity: str, value: float, **bounds) -> Figure:
        made = Figure(case, quantity, float(value), **bounds)
        request.config.stash[FIGURES].append(made)
        assert made.passes, f"{case}: {quantity} is {made.value:.4g} {made.unit}, allowed {bounds}"
        return made

    return record


@pytest.fixture
def compare(figure) -> Callable[..., None]:
    """Record all norms of a run, each below its bound, and each bound below the published scheme's error.

    ``of`` is appended to the names of the norms; norms in ``misses`` may be laxer (the case says why).
    """

    def record(
        case: str,
        bounds: dict[str, float],
        computed: State,
        exact: State,
        published: State,
        of: str = "",
        misses: Collection[str] = (),
    ) -> None:
        measured, yardstick = errors(computed, exact), errors(published, exact)
        for norm, bound in bounds.items():
            lax = bound > yardstick[norm] and norm not in misses
            assert not lax, f"the bound of {norm}{of} is laxer than the published scheme"
            unit = UNITS[norm.split()[-1]]
            figure(case, norm + of, measured[norm], unit=unit, below=bound, yardstick=yardstick[norm])

    return record


@pytest.fixture
def picture(request: pytest.FixtureRequest) -> Callable[..., None]:
    """Keep panels for the documents: ``picture(case, name, *panels)``; those of one name make one picture."""

    def record(case: str, name: str, *panels: Panel) -> None:
        kept = request.config.stash[PICTURES]
        before = next((made for made in kept if made.name == name), None)
        if before is None:
            kept.append(Picture(case, name, panels))
        else:
            kept[kept.index(before)] = Picture(case, name, (*before.panels, *panels))

    return record
