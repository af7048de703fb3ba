"""Run the validation and write its table: ``python -m tests.validation.report``.

The table in ``docs/validation.md`` stands between two marks; the text around it is kept. Round-off figures
show only their bound, so that the file is the same on every machine. With ``FEV_DATA_HOME`` the Malpasset
case runs too; without, its lines are kept as they were.
"""

import sys
from pathlib import Path

import pytest

from tests.validation.figures import FIGURES, Figure
from tests.validation.test_malpasset import CASE as MALPASSET

PAGE = Path(__file__).resolve().parents[2] / "docs" / "validation.md"
BEGIN, END = "<!-- figures: written by tests.validation.report -->", "<!-- figures end -->"


class Collector:
    """Keep the figures of a run of pytest."""

    def __init__(self) -> None:
        self.figures: list[Figure] = []

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        self.figures = list(session.config.stash[FIGURES])


def number(value: float, figure: Figure) -> str:
    """Three significant digits, all of a whole number above a thousand, with the unit."""
    text = f"{value:.0f}" if abs(value) >= 1000.0 else f"{value:.3g}"
    return f"{text} {figure.unit}".strip()


def row(figure: Figure) -> str:
    """One line of the table."""
    allowed = [
        f"{sign} {number(bound, figure)}"
        for sign, bound in ((">=", figure.above), ("<=", figure.below))
        if bound is not None
    ]
    measured = figure.instead or number(figure.value, figure)
    yardstick = "" if figure.yardstick is None else number(figure.yardstick, figure)
    return f"| {figure.quantity} | {measured} | {' and '.join(allowed) or 'reported'} | {yardstick} |"


def sections(figures: list[Figure]) -> dict[str, list[str]]:
    """Lines of the table by case."""
    found: dict[str, list[str]] = {}
    for figure in figures:
        found.setdefault(figure.case, []).append(row(figure))
    return found


def parse(text: str) -> dict[str, list[str]]:
    """The sections that an earlier run has written."""
    found: dict[str, list[str]] = {}
    case = ""
    for line in text.splitlines():
        if line.startswith("### "):
            case = line[4:]
            found[case] = []
        elif case and line.startswith("| ") and not line.startswith("| quantity"):
            found[case].append(line)
    return found


def render(found: dict[str, list[str]]) -> str:
    """The sections as Markdown."""
    head = "| quantity | measured | allowed | yardstick |\n|---|---|---|---|"
    return "\n\n".join(f"### {case}\n\n{head}\n" + "\n".join(lines) for case, lines in found.items())


def main(arguments: list[str]) -> int:
    """Run the folder and rewrite the page; a failing test leaves the page as it was."""
    collector = Collector()
    status = pytest.main([str(Path(__file__).parent), "-q", *arguments], plugins=[collector])
    if status != pytest.ExitCode.OK:
        return int(status)
    page = PAGE.read_text(encoding="utf-8")
    before, rest = page.split(BEGIN)
    old, after = rest.split(END)
    kept = {case: lines for case, lines in parse(old).items() if case == MALPASSET}
    found = dict(sorted((kept | sections(collector.figures)).items()))
    PAGE.write_text(f"{before}{BEGIN}\n\n{render(found)}\n\n{END}{after}", encoding="utf-8")
    print(f"{PAGE}: {len(collector.figures)} figures of {len(sections(collector.figures))} cases")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
