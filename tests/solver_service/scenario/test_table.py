import math

import pytest

from solver_service.errors import CaseError
from solver_service.scenario.table import Table


def run_table(**values) -> Table:
    return Table("case.toml", "run", values)


def test_an_unknown_key_names_the_one_that_was_meant() -> None:
    with pytest.raises(
        CaseError, match=r"case.toml: \[run\] has the unknown key 'durration'; did you mean 'duration'"
    ):
        run_table(durration=1.0)


def test_a_key_like_no_other_lists_what_is_allowed() -> None:
    with pytest.raises(CaseError, match=r"unknown key 'zzz'; arrival_depths, cfl, .* are allowed"):
        run_table(zzz=1)


def test_an_unknown_table_names_the_one_that_was_meant() -> None:
    with pytest.raises(
        CaseError, match=r"the top of the file has the unknown key 'terain'; did you mean 'terrain'"
    ):
        Table("case.toml", "", {"terain": {}})


@pytest.mark.parametrize("value", [0.0, -3.0, math.nan, math.inf, "5", True, None, [1.0], 1e30])
def test_a_number_out_of_range_or_of_another_kind_is_named(value) -> None:
    with pytest.raises(CaseError, match=r"case.toml: \[run\] duration is .*; a time above 0 is allowed\.$"):
        run_table(duration=value).real("duration", "a time above 0", 0.0, 1e9, above=True)


def test_a_missing_number_is_told_or_defaulted() -> None:
    with pytest.raises(CaseError, match=r"\[run\] duration is missing; a time is allowed"):
        run_table().real("duration", "a time")
    assert run_table().real("duration", "a time", default=7.0) == 7.0
    assert run_table().number_or_none("duration", "a time") is None


@pytest.mark.parametrize("value", [[1.0], [1.0, "2"], [1.0, math.nan], "1,2", [[1.0, 2.0]], {"x": 1.0}])
def test_what_is_no_point_is_refused(value) -> None:
    with pytest.raises(CaseError, match=r"\[\[gauge\]\] number 3 at is .*a point \[x, y\]"):
        Table("case.toml", "gauge", {"at": value}, 3).point("at")


def test_points_are_counted() -> None:
    table = Table("case.toml", "section", {"line": [[0, 0], [1.5, 2]]})

    assert table.points("line", 2) == ((0.0, 0.0), (1.5, 2.0))
    with pytest.raises(CaseError, match="3 to 4096 points"):
        table.points("line", 3)


def test_words_are_chosen_from_a_list() -> None:
    with pytest.raises(CaseError, match=r"\[run\] riemann is 'roe'; 'hllc', 'hll' is allowed"):
        run_table(riemann="roe").choice("riemann", ("hllc", "hll"))
    with pytest.raises(CaseError, match=r"is \['hll'\]"):
        run_table(riemann=["hll"]).choice("riemann", ("hllc", "hll"))


def test_a_long_value_is_cut_in_its_error() -> None:
    with pytest.raises(CaseError) as caught:
        run_table(riemann="x" * 100_000).choice("riemann", ("hllc",))

    assert len(str(caught.value)) < 300


def test_flags_and_texts_are_of_their_kind() -> None:
    with pytest.raises(CaseError, match="true or false"):
        Table("case.toml", "case", {"hypothetical": 1}).flag("hypothetical")
    with pytest.raises(CaseError, match="a text of up to 5 characters"):
        Table("case.toml", "case", {"name": "longer"}).text("name", longest=5)


def test_a_table_where_an_array_belongs_is_told() -> None:
    with pytest.raises(CaseError, match=r"'gauge' is not an array of tables; \[\[gauge\]\] is allowed"):
        Table("case.toml", "", {"gauge": {"id": "a"}}).tables("gauge")
    with pytest.raises(CaseError, match=r"'run' is not a table; \[run\] is allowed"):
        Table("case.toml", "", {"run": 5}).table("run")


def test_lists_of_numbers_have_their_length() -> None:
    table = Table("case.toml", "terrain", {"bounds": [0, 1, 2]})

    with pytest.raises(CaseError, match="a list of 4 finite numbers"):
        table.numbers("bounds", 4)
    assert table.numbers("bounds", 3) == (0.0, 1.0, 2.0)
