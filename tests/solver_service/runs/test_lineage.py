import pytest

from solver_service.runs.lineage import Leg, branch_point, lineage, owner

LEGS = {
    "root": (Leg("root", 0, 0, b"", b""), None),
    "child": (Leg("child", 5, 1, b"a", b""), "root"),
    "grandchild": (Leg("grandchild", 9, 2, b"ab", b""), "child"),
}


def legs(name: str) -> tuple[Leg, ...]:
    return lineage(name, LEGS.__getitem__)


def test_a_lineage_goes_from_the_root_to_the_run() -> None:
    assert [leg.run for leg in legs("grandchild")] == ["root", "child", "grandchild"]


@pytest.mark.parametrize(
    ("index", "run"),
    [(0, "root"), (4, "root"), (5, "child"), (8, "child"), (9, "grandchild"), (99, "grandchild")],
)
def test_a_frame_belongs_to_the_last_run_that_begins_at_or_before_it(index: int, run: str) -> None:
    assert owner(legs("grandchild"), index).run == run


@pytest.mark.parametrize(
    ("index", "run"), [(0, "root"), (5, "root"), (6, "child"), (9, "child"), (10, "grandchild")]
)
def test_a_branch_at_the_first_frame_of_a_run_starts_from_its_parent(index: int, run: str) -> None:
    assert branch_point(legs("grandchild"), index).run == run
