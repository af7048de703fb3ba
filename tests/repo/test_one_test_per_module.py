"""The test tree mirrors the packages: who changes a module knows where its tests are."""

from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
PACKAGES = ("protocol", "solver_service", "viewer")

# Modules without a test module of their own, and where they are tested instead. This list may only shrink.
TESTED_ELSEWHERE: dict[str, str] = {}


def modules() -> list[str]:
    """Every module with code of its own, as a path like `protocol/grid.py`."""
    paths = [path for package in PACKAGES for path in sorted((REPOSITORY / package).rglob("*.py"))]
    return [
        path.relative_to(REPOSITORY).as_posix()
        for path in paths
        if path.name not in ("__init__.py", "__main__.py")
    ]


def test_module_of(module: str) -> Path:
    path = REPOSITORY / "tests" / module
    return path.with_name(f"test_{path.name}")


test_module_of.__test__ = False  # type: ignore[attr-defined]  # a helper, not a test


def test_every_module_has_its_test_module() -> None:
    lonely = [
        name for name in modules() if not test_module_of(name).is_file() and name not in TESTED_ELSEWHERE
    ]

    assert not lonely, "\n".join(lonely)


def test_the_list_of_exceptions_only_shrinks() -> None:
    known = set(modules())
    needless = [name for name in TESTED_ELSEWHERE if name not in known or test_module_of(name).is_file()]
    wrong = [place for place in TESTED_ELSEWHERE.values() if not (REPOSITORY / place).exists()]

    assert not needless
    assert not wrong
