"""Terrain edits as GeoJSON (RFC 7946): lines and polygons in the coordinates of the case.

A file names the coordinate system of its case in `crs`, as GIS programs write and read it; coordinates of
another system are refused, never turned. The numbers come back bit for bit. Features drawn in a GIS program
need no properties: what they lack is taken from the settings of the edit tool.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

import protocol
from protocol.limits import MAX_EDITS, MAX_LOG_VERTICES, MAX_VERTICES
from viewer.app.edit_drawing import new_edit, new_edit_id
from viewer.app.whole_file import write_whole
from viewer.errors import ViewerError
from viewer.view_status import EditSettings

__all__ = ["EditFileError", "edits_of_text", "read_edits", "text_of_edits", "write_edits"]

MAX_FILE_BYTES = 16 << 20
"""Largest file that is read."""

_Number = Annotated[float, Meta(ge=-1e9, le=1e9)]
_Position = Annotated[tuple[_Number, ...], Meta(min_length=2, max_length=4)]
_Points = Annotated[tuple[_Position, ...], Meta(min_length=2, max_length=MAX_VERTICES + 1)]


class EditFileError(ViewerError):
    """A file of edits that cannot be read or written; the text names the file and what is wrong."""


class _LineString(msgspec.Struct, tag_field="type", tag="LineString"):
    coordinates: _Points


class _Polygon(msgspec.Struct, tag_field="type", tag="Polygon"):
    coordinates: Annotated[tuple[_Points, ...], Meta(min_length=1, max_length=64)]


class _Properties(msgspec.Struct, omit_defaults=True):
    id: str | int | float | None = None
    name: Annotated[str, Meta(max_length=100)] | None = None
    width: Annotated[float, Meta(gt=0, le=100_000)] | None = None
    operation: protocol.Operation | None = None
    type: protocol.EditType | None = None
    magnitude: Annotated[float, Meta(gt=0, le=10_000)] | None = None
    level: _Number | None = None
    reference_z: Annotated[tuple[_Number, ...], Meta(max_length=MAX_VERTICES)] | None = None


class _Feature(msgspec.Struct):
    type: Literal["Feature"]
    geometry: _LineString | _Polygon
    properties: _Properties | None = None


class _CrsName(msgspec.Struct):
    name: Annotated[str, Meta(max_length=256)]


class _Crs(msgspec.Struct):
    type: Literal["name"]
    properties: _CrsName


class _Collection(msgspec.Struct, omit_defaults=True):
    type: Literal["FeatureCollection"]
    features: Annotated[tuple[_Feature, ...], Meta(max_length=MAX_EDITS)]
    crs: _Crs | None = None
    datum_offset: _Number | None = None


_ID = re.compile(r"[A-Za-z0-9_-]{1,64}")
_DECODER = msgspec.json.Decoder(_Collection)


def text_of_edits(edits: Sequence[protocol.Edit], grid: protocol.GridGeometry) -> bytes:
    """Return edits as the text of a GeoJSON file."""
    collection = _Collection(
        "FeatureCollection",
        tuple(_feature(edit) for edit in edits),
        None if grid.crs == "local" else _Crs("name", _CrsName(_long_name(grid.crs))),
        grid.datum_offset,
    )
    return msgspec.json.format(msgspec.json.encode(collection), indent=1) + b"\n"


def edits_of_text(
    text: bytes,
    grid: protocol.GridGeometry,
    settings: EditSettings,
    ground: Callable[[float, float], float],
    taken: Collection[str] = (),
) -> tuple[protocol.Edit, ...]:
    """Return the edits in the text of a GeoJSON file, checked against a terrain.

    Args:
        text: the text.
        grid: geometry of the terrain.
        settings: what features without properties of their own become.
        ground: elevation at a point [m, datum-relative], for edits that bring no ground of their own.
        taken: ids that the edits must not have; one that is taken is replaced by a new one.

    Raises:
        EditFileError: it is no GeoJSON of lines and polygons, or too large, or of another coordinate system.
        protocol.EditError: an edit does not fit the terrain.
    """
    try:
        collection = _DECODER.decode(text)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise EditFileError(f"it is no GeoJSON of lines and polygons: {error}") from None
    crs = None if collection.crs is None else _short_name(collection.crs.properties.name)
    if crs is not None and crs != _short_name(grid.crs):
        raise EditFileError(f"its coordinates are of {crs}; those of the terrain, {grid.crs}, are needed")
    rise = 0.0 if collection.datum_offset is None else collection.datum_offset - grid.datum_offset
    ids = set(taken)
    edits = []
    vertices = 0
    for number, feature in enumerate(collection.features, 1):
        edit = _edit(feature, number, settings, ground, rise)
        vertices += len(edit.vertices)
        if vertices > MAX_LOG_VERTICES:
            raise EditFileError(f"it has more than {MAX_LOG_VERTICES} points; no more are allowed")
        if edit.id in ids:
            edit = msgspec.structs.replace(edit, id=new_edit_id())
        ids.add(edit.id)
        protocol.check_edit(edit, grid)
        edits.append(edit)
    return tuple(edits)


def write_edits(path: Path, edits: Sequence[protocol.Edit], grid: protocol.GridGeometry) -> None:
    """Write edits to a file; a half-written one never bears the name.

    Raises:
        EditFileError: it cannot be written.
    """
    try:
        write_whole(path, text_of_edits(edits, grid))
    except OSError as error:
        raise EditFileError(f"{path}: cannot be written: {error.strerror}") from None


def read_edits(
    path: Path,
    grid: protocol.GridGeometry,
    settings: EditSettings,
    ground: Callable[[float, float], float],
    taken: Collection[str] = (),
) -> tuple[protocol.Edit, ...]:
    """Return the edits of a file; see `edits_of_text`.

    Raises:
        EditFileError: it cannot be read, or is not such a file; the text begins with its path.
    """
    try:
        with path.open("rb") as file:
            text = file.read(MAX_FILE_BYTES + 1)
    except OSError as error:
        raise EditFileError(f"{path}: cannot be read: {error.strerror}") from None
    if len(text) > MAX_FILE_BYTES:
        raise EditFileError(f"{path}: has more than {MAX_FILE_BYTES} bytes; no more are allowed")
    try:
        return edits_of_text(text, grid, settings, ground, taken)
    except (EditFileError, protocol.EditError) as error:
        raise EditFileError(f"{path}: {error}") from None


def _feature(edit: protocol.Edit) -> _Feature:
    is_line = isinstance(edit, protocol.EditLine)
    geometry = _LineString(edit.vertices) if is_line else _Polygon(((*edit.vertices, edit.vertices[0]),))
    properties = _Properties(
        edit.id,
        edit.name or None,
        edit.width if isinstance(edit, protocol.EditLine) else None,
        edit.operation,
        edit.type,
        edit.magnitude,
        edit.level,
        edit.reference_z,
    )
    return _Feature("Feature", geometry, properties)


def _edit(
    feature: _Feature,
    number: int,
    settings: EditSettings,
    ground: Callable[[float, float], float],
    rise: float,
) -> protocol.Edit:
    given = feature.properties or _Properties()
    points: list[Any] = []
    if isinstance(feature.geometry, _LineString):
        points = [place[:2] for place in feature.geometry.coordinates]
    else:
        ring, *holes = feature.geometry.coordinates
        if holes:
            raise EditFileError(f"feature {number} is a polygon with holes; one ring is allowed")
        points = [place[:2] for place in (ring[:-1] if ring[0] == ring[-1] else ring)]
    reference = given.reference_z
    if reference is not None and rise:
        reference = tuple(z + rise for z in reference)
    kind = given.type or protocol.EditType(settings.type)
    level = given.level
    if given.type is None and level is None and kind is protocol.EditType.replace and settings.at_level:
        level = settings.level
    if reference is None and level is None and kind is protocol.EditType.replace:
        reference = tuple(ground(x, y) for x, y in points)
    try:
        return new_edit(
            "line" if isinstance(feature.geometry, _LineString) else "area",
            points,
            id=given.id if isinstance(given.id, str) and _ID.fullmatch(given.id) else None,
            name=given.name or "",
            width=given.width or settings.width,
            operation=given.operation or protocol.Operation(settings.operation),
            type=kind,
            magnitude=given.magnitude or settings.magnitude,
            level=level,
            reference_z=reference,
        )
    except ValueError as error:
        raise EditFileError(f"feature {number}: {error}") from None


def _long_name(crs: str) -> str:
    found = re.fullmatch(r"EPSG:([0-9]+)", crs)
    return crs if found is None else f"urn:ogc:def:crs:EPSG::{found[1]}"


def _short_name(crs: str) -> str:
    found = re.fullmatch(r"urn:ogc:def:crs:EPSG:[0-9.]*:([0-9]+)", crs)
    return crs if found is None else f"EPSG:{found[1]}"
