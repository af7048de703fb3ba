"""Tables of the reference page, made from the definitions they describe.

`python -m protocol.reference docs/reference/protocol.md` renews the tables of the page, which stand between
`<!-- begin NAME -->` and `<!-- end NAME -->`; a test tells when they are out of date.
"""

from __future__ import annotations

import ast
import inspect
import re
import sys
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path
from typing import get_args

import msgspec
from msgspec import inspect as types

from protocol import errors, limits
from protocol.codec import operation
from protocol.edits.model import EditArea, EditLine
from protocol.forcing import ForcingChange, ForcingItem, ForcingSeries
from protocol.messages import (
    CaseSummary,
    Channel,
    ClientMessage,
    GaugePlace,
    GridInfo,
    LineageEntry,
    Message,
    ResumePoint,
    RunInfo,
    SectionPlace,
    Series,
    ServerMessage,
    View,
    WireLimits,
    WireStruct,
)

RECORDS: tuple[type[WireStruct], ...] = (
    ResumePoint,
    WireLimits,
    CaseSummary,
    RunInfo,
    GridInfo,
    LineageEntry,
    Channel,
    Series,
    GaugePlace,
    SectionPlace,
    EditLine,
    EditArea,
    ForcingItem,
    ForcingChange,
    ForcingSeries,
    View,
)


def sections() -> dict[str, str]:
    """Every generated part of the page by its name, as Markdown."""
    return {
        "client messages": _structs(get_args(ClientMessage)),
        "server messages": _structs(get_args(ServerMessage)),
        "records": _structs(RECORDS),
        "errors": _errors(),
        "limits": _limits(),
    }


def renew(page: str) -> str:
    """The page with its generated parts up to date.

    Raises:
        ValueError: when a part has no place in the page.
    """
    for name, text in sections().items():
        begin, end = f"<!-- begin {name} -->", f"<!-- end {name} -->"
        before, found_begin, rest = page.partition(begin)
        _, found_end, after = rest.partition(end)
        if not (found_begin and found_end):
            raise ValueError(f"The page has no place for {name!r}: {begin} ... {end} is missing.")
        page = f"{before}{begin}\n\n{text}\n{end}{after}"
    return page


def _structs(kinds: Iterable[type[WireStruct]]) -> str:
    return "\n".join(_struct(kind) for kind in kinds)


def _struct(kind: type[WireStruct]) -> str:
    text, meanings = _parse_docstring(inspect.cleandoc(kind.__doc__ or ""))
    title = f"`{operation(kind)}`" if issubclass(kind, Message) else kind.__name__
    lines = [f"### {title}", "", text, ""]
    info = types.type_info(kind)
    assert isinstance(info, types.StructType)
    rows = [_field_row(field, meanings) for field in info.fields]
    if not issubclass(kind, Message) and info.tag_field is not None:
        rows.insert(0, f"| `{info.tag_field}` | `{info.tag!r}` | required | tells the kind of edit |")
    if rows:
        lines += ["| field | type | default | meaning |", "| --- | --- | --- | --- |", *rows, ""]
    return "\n".join(lines)


def _field_row(field: types.Field, meanings: dict[str, str]) -> str:
    meaning = meanings.get(field.encode_name, "")
    if not meaning and field.encode_name == "id":
        meaning = "number of the command, larger than any before on this connection."
    default = "required" if field.required else f"`{_default(field)}`"
    return f"| `{field.encode_name}` | {_type_name(field.type)} | {default} | {meaning.rstrip('.')} |"


def _default(field: types.Field) -> str:
    if field.default_factory is not msgspec.NODEFAULT:
        return "{}"
    if isinstance(field.default, WireStruct):
        return type(field.default).__name__
    if isinstance(field.default, tuple):
        return "[" + ", ".join(f'"{item}"' for item in field.default) + "]"
    names = {None: "nil", True: "true", False: "false"}
    if field.default is None or isinstance(field.default, bool):
        return names[field.default]
    return f'"{field.default}"' if isinstance(field.default, str) else str(field.default)


def _type_name(kind: types.Type) -> str:
    """A type and its limits in words."""
    match kind:
        case types.Metadata():
            return _type_name(kind.type)
        case types.UnionType():
            return " or ".join(_type_name(each) for each in kind.types)
        case types.LiteralType():
            return " or ".join(f'`"{value}"`' for value in kind.values)
        case types.EnumType():
            return " or ".join(f'`"{each.value}"`' for each in kind.cls)
        case types.StructType():
            return kind.cls.__name__
        case types.VarTupleType():
            return f"array of {_type_name(kind.item_type)}{_lengths(kind)}"
        case types.TupleType():
            return f"array [{', '.join(_type_name(each) for each in kind.item_types)}]"
        case types.DictType():
            return f"map of text to {_type_name(kind.value_type)}"
        case types.StrType(pattern=pattern) if pattern:
            return f"text {_code(pattern)}"
        case types.StrType() | types.BytesType():
            return f"{'text' if isinstance(kind, types.StrType) else 'bytes'}{_lengths(kind)}"
        case types.IntType() | types.FloatType():
            return f"{'int' if isinstance(kind, types.IntType) else 'float'}{_bounds(kind)}"
    return {types.NoneType: "nil", types.BoolType: "bool"}[type(kind)]


def _code(pattern: str) -> str:
    return "`" + pattern.replace("|", "\\|").replace(r"\Z", "$") + "`"


def _bounds(kind: types.IntType | types.FloatType) -> str:
    if kind.ge is not None and kind.le is not None:
        return f" {_number(kind.ge)} to {_number(kind.le)}"
    limits_of_kind = ((">", kind.gt), (">=", kind.ge), ("<", kind.lt), ("<=", kind.le))
    parts = [f"{sign} {_number(value)}" for sign, value in limits_of_kind if value is not None]
    return f" {', '.join(parts)}" if parts else ""


def _number(value: float) -> str:
    if isinstance(value, int) and value > 10**9 and value.bit_count() == 1:
        return f"2^{value.bit_length() - 1}"
    return str(value) if isinstance(value, int) else f"{value:g}"


def _lengths(kind: types.VarTupleType | types.StrType | types.BytesType) -> str:
    low, high = kind.min_length, kind.max_length
    if high is None:
        return ""
    return f" ({low} to {high})" if low else f" (up to {high})"


def _parse_docstring(text: str) -> tuple[str, dict[str, str]]:
    """Text of a docstring before its attributes, and the meaning of each attribute."""
    text, _, attributes = text.partition("Attributes:")
    meanings: dict[str, str] = {}
    name = ""
    for line in attributes.splitlines():
        begun = re.match(r"    (\w+): (.*)", line)
        if begun:
            name, meanings[begun[1]] = begun[1], begun[2]
        elif name and line.strip():
            meanings[name] += " " + line.strip()
    return text.strip(), meanings


def _errors() -> str:
    rows = ["| code | close code | fatal | meaning |", "| --- | --- | --- | --- |"]
    kinds = [errors.ProtocolError]
    while kinds:
        kind = kinds.pop(0)
        kinds[:0] = kind.__subclasses__()
        if kind is not errors.ProtocolError:
            text = inspect.cleandoc(kind.__doc__ or "").splitlines()[0].rstrip(".")
            fatal = "yes" if kind.fatal else "no"
            rows.append(f"| `{kind.code}` | {kind.close_code} | {fatal} | {text} |")
    return "\n".join(rows) + "\n"


def _limits() -> str:
    rows = ["| name | value | meaning |", "| --- | --- | --- |"]
    body = ast.parse(inspect.getsource(limits)).body
    for definition, comment in pairwise(body):
        if isinstance(definition, ast.Assign) and isinstance(comment, ast.Expr):
            name = ast.unparse(definition.targets[0])
            text = " ".join(str(ast.literal_eval(comment.value)).split()).rstrip(".")
            rows.append(f"| `{name}` | {getattr(limits, name)} | {text} |")
    return "\n".join(rows) + "\n"


def main(path: Path) -> None:
    """Renew the page in its file."""
    path.write_text(renew(path.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
