"""Run the validation, write its tables and draw its pictures: ``python -m tests.validation.report``.

The table in ``docs/validation.md`` stands between two marks; the text around it is kept. Round-off figures
show only their bound, so that the file is the same on every machine. Cases whose data are not there
(``FEV_DATA_HOME``) are skipped; then, and where test files are named as arguments, sections that were not
measured are kept as they were. Pictures go to ``docs/images/validation``.
"""

import sys
from pathlib import Path

import pytest

from tests.validation.figures import FIGURES, Figure
from tests.validation.pictures import PICTURES, Picture, draw

PAGE = Path(__file__).resolve().parents[2] / "docs" / "validation.md"
IMAGES = PAGE.parent / "images" / "validation"
LARGEST_IMAGE = 80_000
BEGIN, END = "<!-- figures: written by tests.validation.report -->", "<!-- figures end -->"


class Collector:
    """Keep the figures and pictures of a run of pytest."""

    def __init__(self) -> None:
        self.figures: list[Figure] = []
        self.pictures: list[Picture] = []
        self.skipped = False

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.skipped = self.skipped or report.skipped

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        self.figures = list(session.config.stash[FIGURES])
        self.pictures = list(session.config.stash[PICTURES])


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


def sections(figures: list[Figure], shown: dict[str, list[str]]) -> dict[str, str]:
    """Pictures and table of each case, as Markdown."""
    head = "| quantity | measured | allowed | yardstick |\n|---|---|---|---|\n"
    rows: dict[str, list[str]] = {}
    for figure in figures:
        rows.setdefault(figure.case, []).append(row(figure))
    return {case: "".join(shown.get(case, [])) + head + "\n".join(lines) for case, lines in rows.items()}


def parse(text: str) -> dict[str, str]:
    """The sections that an earlier run has written."""
    parts = [part.split("\n", 1) for part in text.split("### ")[1:]]
    return {case: body.strip() for case, body in parts}


def show(pictures: list[Picture]) -> dict[str, list[str]]:
    """Draw the pictures and return their lines by case."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    found: dict[str, list[str]] = {}
    for picture in pictures:
        path = draw(picture, IMAGES)
        size = path.stat().st_size
        if size > LARGEST_IMAGE:
            raise ValueError(f"{path} has {size} bytes; {LARGEST_IMAGE} are allowed.")
        line = f"![{picture.case}](images/validation/{path.name})\n\n"
        found.setdefault(picture.case, []).append(line)
    return found


def main(arguments: list[str]) -> int:
    """Run the folder, or the files named, and rewrite the page; a failing test leaves it as it was."""
    collector = Collector()
    is_part = any(Path(word.partition("::")[0]).exists() for word in arguments)
    what = arguments if is_part else [str(Path(__file__).parent), *arguments]
    status = pytest.main(["-q", *what], plugins=[collector])
    if status != pytest.ExitCode.OK:
        return int(status)
    page = PAGE.read_text(encoding="utf-8")
    before, rest = page.split(BEGIN)
    old, after = rest.split(END)
    found = sections(collector.figures, show(collector.pictures))
    kept = parse(old) if collector.skipped or is_part else {}
    body = "\n\n".join(f"### {case}\n\n{text}" for case, text in sorted((kept | found).items()))
    PAGE.write_text(f"{before}{BEGIN}\n\n{body}\n\n{END}{after}", encoding="utf-8")
    for path in IMAGES.iterdir():
        if path.name not in body:
            path.unlink()
    print(f"{PAGE}: {len(collector.figures)} figures of {len(found)} cases")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
