import pytest

from protocol import CaseList, CaseSummary, InvalidMessage, pack, unpack_server


def case(**change: object) -> CaseSummary:
    fields = {"name": "c", "title": "t", "hypothetical": False, "nrows": 2, "ncols": 3, "dx": 1.0}
    return CaseSummary(**(fields | {"duration": 10.0, "output_interval": 1.0} | change))  # type: ignore[arg-type]


def test_an_empty_list_is_a_list() -> None:
    assert unpack_server(pack(CaseList(1, ()))) == CaseList(1, ())


@pytest.mark.parametrize(
    "change", [{"nrows": 0}, {"ncols": 1 << 17}, {"dx": 0.0}, {"duration": -1.0}, {"output_interval": 0.0}]
)
def test_an_impossible_case_is_refused(change: dict[str, object]) -> None:
    with pytest.raises(InvalidMessage, match=next(iter(change))):
        unpack_server(pack(CaseList(1, (case(**change),))))
