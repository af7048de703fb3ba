"""What the documentation says can be typed exists, and its links lead somewhere."""

import ast
import functools
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
PAGES = sorted(
    [REPOSITORY / "README.md", REPOSITORY / "docker" / "README.md", *(REPOSITORY / "docs").rglob("*.md")]
)
FENCE = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)
PROGRAMS = {
    "fev-solver": ["-m", "solver_service"],
    "fev-viewer": ["-m", "viewer"],
    "./fev": ["fev"],
    ".ci/run": [],
}
STAGES = {"lint", "types", "layers", "tests", "docs", "bench"}


def relative(path: Path) -> str:
    return path.relative_to(REPOSITORY).as_posix()


def blocks(language: str) -> Iterator[tuple[Path, str]]:
    """The fenced blocks of one language in all pages."""
    for path in PAGES:
        for found, text in FENCE.findall(path.read_text(encoding="utf-8")):
            if found == language:
                yield path, text


def command_lines() -> list[tuple[str, list[str]]]:
    """(page, words) of every line in a shell block that starts one of our programs."""
    lines = []
    for path, text in blocks("sh"):
        for line in re.sub(r"\\\n\s*", "", text).splitlines():
            words = shlex.split(line, comments=True)
            if not words:
                continue
            name = words[0].removeprefix(".venv/bin/")
            if name in ("python", "python3") and words[1:3] == ["-m", "bench"]:
                lines.append((relative(path), ["bench", *words[3:]]))
            elif name in PROGRAMS:
                lines.append((relative(path), [name, *words[1:]]))
    return lines


@functools.cache
def help_of(*command: str) -> str:
    environment = dict(os.environ, COLUMNS="300", NO_COLOR="1", TERM="dumb")
    answer = subprocess.run(
        [sys.executable, *command, "--help"],
        cwd=REPOSITORY,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert answer.returncode == 0, f"{command}: {answer.stderr}"
    return answer.stdout


def test_the_pages_show_the_two_commands_and_the_programs() -> None:
    shown = {" ".join(words[:2]) for _, words in command_lines()}

    assert {"./fev demo", "./fev test", "fev-solver run", "fev-solver serve", "fev-solver check"} <= shown


def test_every_command_in_the_pages_exists_with_its_options() -> None:
    for page, (program, *arguments) in command_lines():
        line = f"{page}: {program} {' '.join(arguments)}"
        options = [word.partition("=")[0] for word in arguments if word.startswith("--")]
        if program == "bench":
            place = REPOSITORY / "bench" / arguments[0]
            assert place.with_suffix(".py").is_file() or (place / "__init__.py").is_file(), line
        elif program == ".ci/run":
            assert set(arguments) <= STAGES, line
        elif program == "./fev":
            assert not arguments or re.search(rf"^ +\./fev {arguments[0]}\b", help_of("fev"), re.MULTILINE), (
                line
            )
        else:
            general = help_of(*PROGRAMS[program])
            is_command = bool(arguments) and re.search(
                rf"^[ |\u2502]+{arguments[0]}\b", general, re.MULTILINE
            )
            text = help_of(*PROGRAMS[program], arguments[0]) if is_command else general
            if is_command and "COMMAND [ARGS]" in text:
                text = help_of(*PROGRAMS[program], *arguments[:2])
            assert is_command or program == "fev-viewer", f"{line}: there is no such command"
            for option in options:
                assert re.search(rf"{option}\b", text), f"{line}: there is no option {option}"


def test_every_solver_command_is_documented() -> None:
    general = help_of(*PROGRAMS["fev-solver"])
    commands = set(re.findall(r"^[ |\u2502]+([a-z]+)  +\S", general, re.MULTILINE))
    pages = "\n".join(path.read_text(encoding="utf-8") for path in PAGES)

    assert {"run", "serve", "check", "warmup", "doctor"} <= commands
    assert not [command for command in commands if f"fev-solver {command}" not in pages]


def test_the_stages_of_the_check_are_those_of_the_contributing_page() -> None:
    script = (REPOSITORY / ".ci" / "run").read_text(encoding="utf-8")
    page = (REPOSITORY / "docs" / "CONTRIBUTING.md").read_text(encoding="utf-8")

    (stages,) = re.findall(r'ALL_STAGES="([a-z ]+)"', script)
    assert set(stages.split()) == STAGES
    assert re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE) == stages.split()


@pytest.mark.parametrize("path", PAGES, ids=relative)
def test_every_link_to_a_file_leads_to_one(path: Path) -> None:
    text = FENCE.sub("", path.read_text(encoding="utf-8"))
    targets = [target.partition("#")[0] for target in re.findall(r"\]\(([^)\s]+)\)", text)]

    assert not [t for t in targets if t and "://" not in t and not (path.parent / t).exists()]


def test_python_in_the_pages_is_python() -> None:
    for path, text in blocks("python"):
        try:
            ast.parse(text)
        except SyntaxError as error:
            pytest.fail(f"{relative(path)}: {error}")


def test_the_case_of_the_how_to_page_can_be_loaded(tmp_path: Path) -> None:
    import numpy as np
    import rasterio
    from rasterio.transform import from_origin

    from solver_service.scenario import load_case

    page = REPOSITORY / "docs" / "how_to" / "bring_a_dem.md"
    ((_, case_file),) = [block for block in blocks("toml") if block[0] == page]
    (tmp_path / "case.toml").write_text(case_file, encoding="utf-8")
    east = np.arange(200, dtype=np.float32)
    valley = np.broadcast_to(320.0 - 0.2 * east, (100, 200)).astype(np.float32)
    with rasterio.open(
        tmp_path / "bed.tif",
        "w",
        driver="GTiff",
        height=100,
        width=200,
        count=1,
        dtype="float32",
        crs="EPSG:32617",
        transform=from_origin(700_000.0, 4_001_000.0, 10.0, 10.0),
    ) as raster:
        raster.write(valley, 1)

    case = load_case(tmp_path / "case.toml")

    assert case.grid.shape == (100, 200)
    assert case.initial_h.max() > 1.0
