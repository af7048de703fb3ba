import json
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

import protocol
from viewer.app.edit_geojson import (
    MAX_FILE_BYTES,
    EditFileError,
    edits_of_text,
    read_edits,
    text_of_edits,
    write_edits,
)
from viewer.view_status import EditSettings

GRID = protocol.GridGeometry(60, 80, 10.0, 1000.0, 2000.0, "EPSG:32616", datum_offset=250.0)
SETTINGS = EditSettings(width=12.0, magnitude=2.0, operation="lower", type="replace")
TRIANGLE = [[1100.0, 2100.0], [1200.0, 2100.0], [1200.0, 2200.0]]
X, Y = st.floats(1000.0, 1800.0), st.floats(2000.0, 2600.0)


def slope(x: float, _y: float) -> float:
    return 0.1 * (x - 1000.0)


def read(text: bytes | dict[str, Any], **options: Any) -> tuple[protocol.Edit, ...]:
    packed = text if isinstance(text, bytes) else json.dumps(text).encode()
    return edits_of_text(packed, options.pop("grid", GRID), SETTINGS, slope, **options)


def collection(*geometries: dict[str, Any], **more: Any) -> dict[str, Any]:
    features = [{"type": "Feature", "geometry": geometry, "properties": None} for geometry in geometries]
    return {"type": "FeatureCollection", "features": features, **more}


def line(**properties: Any) -> dict[str, Any]:
    made = collection({"type": "LineString", "coordinates": TRIANGLE})
    made["features"][0]["properties"] = properties
    return made


@st.composite
def any_edits(draw: st.DrawFn) -> tuple[protocol.Edit, ...]:
    edits: list[protocol.Edit] = []
    for number in range(draw(st.integers(1, 4))):
        is_area = draw(st.booleans())
        places = draw(st.lists(st.tuples(X, Y), min_size=3 if is_area else 2, max_size=6, unique=True))
        kind = draw(st.sampled_from(protocol.EditType))
        level = draw(st.none() | st.floats(-100.0, 900.0))
        shared = (
            draw(st.sampled_from(protocol.Operation)),
            kind,
            draw(st.floats(0.01, 50.0)),
            level,
            tuple(draw(st.floats(-100.0, 900.0)) for _ in places),
            draw(st.text(max_size=20)),
        )
        if is_area:
            edits.append(protocol.EditArea(f"a{number}", tuple(places), *shared))
        else:
            edits.append(protocol.EditLine(f"l{number}", tuple(places), draw(st.floats(0.1, 90.0)), *shared))
    return tuple(edits)


@given(any_edits())
def test_edits_come_back_bit_for_bit(edits: tuple[protocol.Edit, ...]) -> None:
    try:
        for edit in edits:
            protocol.check_edit(edit, GRID)
    except protocol.EditError:
        return  # too thin to cover a cell
    assert read(text_of_edits(edits, GRID)) == edits


def test_a_file_is_geojson_with_the_coordinate_system_of_the_case() -> None:
    area = protocol.EditArea(
        "pit",
        tuple((x, y) for x, y in TRIANGLE),
        protocol.Operation.lower,
        protocol.EditType.modulate,
        1.5,
        name="Pit",
    )
    written = json.loads(text_of_edits([area], GRID))

    assert written["crs"]["properties"]["name"] == "urn:ogc:def:crs:EPSG::32616"
    (feature,) = written["features"]
    assert feature["geometry"] == {"type": "Polygon", "coordinates": [[*TRIANGLE, TRIANGLE[0]]]}
    assert feature["properties"] == {
        "id": "pit",
        "name": "Pit",
        "operation": "lower",
        "type": "modulate",
        "magnitude": 1.5,
    }
    assert "crs" not in json.loads(text_of_edits([area], protocol.GridGeometry(60, 80, 10.0, 1000.0, 2000.0)))


def test_a_feature_without_properties_is_what_the_tool_would_draw() -> None:
    drawn = collection(
        {"type": "LineString", "coordinates": [[*place, 7.0] for place in TRIANGLE]},
        {"type": "Polygon", "coordinates": [[*TRIANGLE, TRIANGLE[0]]]},
    )
    first, second = read(drawn)

    assert isinstance(first, protocol.EditLine)
    assert isinstance(second, protocol.EditArea)
    assert (first.width, first.magnitude, first.operation, first.type) == (12.0, 2.0, "lower", "replace")
    assert first.vertices == second.vertices == tuple((x, y) for x, y in TRIANGLE)
    assert first.reference_z == second.reference_z == pytest.approx((10.0, 20.0, 20.0))
    assert first.id != second.id


def test_an_id_that_is_taken_or_no_id_is_given_anew() -> None:
    assert read(line(id="a"))[0].id == "a"
    for name in ("a", 17, "not an id", None):
        assert read(line(id=name), taken=["a"])[0].id.startswith("edit-")
    twice = line(id="b")
    twice["features"] *= 2
    assert len({edit.id for edit in read(twice)}) == 2


def test_the_ground_of_a_crest_follows_the_datum_of_the_terrain() -> None:
    edits = read(line(type="replace", reference_z=[1.0, 2.0, 3.0]) | {"datum_offset": 260.0})
    assert edits[0].reference_z == (11.0, 12.0, 13.0)


def test_the_names_of_a_coordinate_system_are_one() -> None:
    for name in ("EPSG:32616", "urn:ogc:def:crs:EPSG::32616", "urn:ogc:def:crs:EPSG:9.6:32616"):
        crs = {"type": "name", "properties": {"name": name}}
        assert len(read(line() | {"crs": crs})) == 1
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}
    with pytest.raises(EditFileError, match="CRS84; those of the terrain, EPSG:32616"):
        read(line() | {"crs": crs})


HOSTILE = {
    "empty": b"",
    "no json": b"hello",
    "no utf-8": b'{"type": "FeatureCollection\xff"}',
    "nested": b"[" * 100_000,
    "nested within": b'{"type": "FeatureCollection", "features": [], "x": ' + b"[" * 100_000,
    "another type": {"type": "Feature", "features": []},
    "no features": {"type": "FeatureCollection"},
    "too many features": collection(*[{"type": "LineString", "coordinates": TRIANGLE}] * 1025),
    "a point": collection({"type": "Point", "coordinates": [1100.0, 2100.0]}),
    "no geometry": collection(None),  # type: ignore[arg-type]
    "one place": collection({"type": "LineString", "coordinates": TRIANGLE[:1]}),
    "a place of one number": collection({"type": "LineString", "coordinates": [[1.0], [2.0]]}),
    "text for a number": collection({"type": "LineString", "coordinates": [["1", 2.0], [2.0, 3.0]]}),
    "a truth for a number": collection({"type": "LineString", "coordinates": [[True, 2.0], [2.0, 3.0]]}),
    "not a number": b'{"type": "FeatureCollection", "features": [{"type": "Feature", "geometry":'
    b' {"type": "LineString", "coordinates": [[NaN, 1], [2, 3]]}}]}',
    "infinite": b'{"type": "FeatureCollection", "features": [{"type": "Feature", "geometry":'
    b' {"type": "LineString", "coordinates": [[1e999, 1], [2, 3]]}}]}',
    "far away": collection({"type": "LineString", "coordinates": [[1e10, 2.0], [2.0, 3.0]]}),
    "too many places": collection({"type": "LineString", "coordinates": [[1100.0, 2100.0]] * 4098}),
    "a ring of two": collection({"type": "Polygon", "coordinates": [TRIANGLE[:2]]}),
    "no ring": collection({"type": "Polygon", "coordinates": []}),
    "holes": collection({"type": "Polygon", "coordinates": [TRIANGLE, TRIANGLE]}),
    "no width": line(width=0.0),
    "no magnitude": line(magnitude=-1.0),
    "another operation": line(operation="dig"),
    "another kind": line(type="paint"),
    "a long name": line(name="x" * 101),
    "a level in space": line(level=1e6),
    "a reference that does not fit": line(type="replace", reference_z=[1.0]),
    "too many vertices in all": collection(
        *[{"type": "LineString", "coordinates": [[1100.0 + n % 9, 2100.0] for n in range(4000)]}] * 9
    ),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_is_refused_in_one_sentence(name: str) -> None:
    with pytest.raises((EditFileError, protocol.EditError)) as caught:
        read(HOSTILE[name])
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400


def test_an_edit_outside_the_terrain_is_refused() -> None:
    there = collection({"type": "LineString", "coordinates": [[1100.0, 2100.0], [9e4, 2100.0]]})
    with pytest.raises(protocol.EditError, match="outside the terrain"):
        read(there)


def test_a_file_too_large_is_not_read_and_what_is_wrong_names_the_file(tmp_path: Path) -> None:
    large = tmp_path / "large.geojson"
    with large.open("wb") as file:
        file.truncate(MAX_FILE_BYTES + 1)
    wrong = tmp_path / "wrong.geojson"
    wrong.write_text("{}")
    for path in (large, wrong, tmp_path / "none.geojson", tmp_path):
        with pytest.raises(EditFileError, match=str(path)):
            read_edits(path, GRID, SETTINGS, slope)


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    (made,) = read(line(id="a"))
    path = tmp_path / "edits.geojson"
    write_edits(path, [made], GRID)
    assert read_edits(path, GRID, SETTINGS, slope) == (made,)
    before = path.read_bytes()
    path.with_name("edits.geojson.part").mkdir()
    with pytest.raises(EditFileError, match="cannot be written"):
        write_edits(path, [msgspec.structs.replace(made, name="other")], GRID)
    assert path.read_bytes() == before
