from pathlib import Path

import pytest

from solver_service.errors import CaseError
from solver_service.scenario import csv_file
from solver_service.scenario.csv_file import read_csv


def written(folder: Path, text: str) -> Path:
    path = folder / "table.csv"
    path.write_bytes(text.encode())
    return path


def test_cells_are_read_by_column_with_their_line_numbers(tmp_path: Path) -> None:
    columns, lines = read_csv(written(tmp_path, '\ufeffa, b\r\n1 ,"x, y"\r\n\r\n ,\r\n2,3\r\n'))

    assert columns == ["a", "b"]
    assert [(line.number, line.text("a"), line.text("b")) for line in lines] == [
        (2, "1", "x, y"),
        (5, "2", "3"),
    ]
    assert lines[1].real("b", 0.0, 3.0) == 3.0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty; line 1 must name the columns"),
        ("a,a\n1,2\n", "line 1 names a column twice"),
        ("a,b\n1\n", "line 2 has 1 cells; line 1 names 2 columns"),
        ("a,b\n1,2,3\n", "line 2 has 3 cells; line 1 names 2 columns"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(CaseError, match=f"^table.csv: {message}"):
        read_csv(written(tmp_path, text))


@pytest.mark.parametrize(
    ("cell", "message"),
    [
        ("", "line 2 has no 'b'; a number is needed in every line, so fill the gap"),
        ("1;5", "line 2 has '1;5' in column 'b', which is not a number"),
        ("nan", "line 2 has nan in column 'b'; a number from 0 to 9 is allowed"),
        ("-1", "line 2 has -1 in column 'b'; a number from 0 to 9 is allowed"),
    ],
)
def test_a_bad_number_is_told_with_line_and_column(tmp_path: Path, cell: str, message: str) -> None:
    _, (line,) = read_csv(written(tmp_path, f"a,b\n1,{cell}\n"))

    with pytest.raises(CaseError, match=f"^table.csv: {message}"):
        line.real("b", 0.0, 9.0)


def test_bytes_that_are_no_text_and_huge_files_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "table.csv"
    path.write_bytes(b"\xff\xfe\x00a")
    with pytest.raises(CaseError, match="cannot be read as CSV"):
        read_csv(path)

    long = written(tmp_path, "a\n1\n2\n")
    monkeypatch.setattr(csv_file, "MAX_LINES", 2)
    with pytest.raises(CaseError, match="has 3 lines; up to 2 are allowed"):
        read_csv(long)

    monkeypatch.setattr(csv_file, "MAX_FILE_BYTES", 3)
    with pytest.raises(CaseError, match="is larger than 3 bytes"):
        read_csv(path)
