"""Log lines of the service and its workers, as text or as JSON, one format for all of them.

Every line has time, level, logger and message, and the ids of session, run and token where there are such.
A secret never appears: the token of the token file is concealed wherever it stands, tokens of the token
store are known by their shape, and what follows the `?` of an address is left out.
"""

from __future__ import annotations

import json
import logging
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from datetime import UTC, datetime
from typing import TextIO

IDS = ("session", "run", "token")
LEVELS = ("debug", "info", "warning", "error")
OWN = ("solver_service", "protocol")
CONCEALED = "(concealed)"

_context: ContextVar[dict[str, str] | None] = ContextVar("log_context", default=None)
_secrets: set[str] = set()
_STORED_TOKEN = re.compile(r"\bfev-([0-9a-f]{8})-[A-Za-z0-9_-]{16,}")
_QUERY = re.compile(r"\?[^\s\"]+")
_CONTROL = {code: f"\\u{code:04x}" for code in (*range(32), *range(127, 160), 0x2028, 0x2029)}
"""What could end a line, or tell a terminal to do something."""


@contextmanager
def log_context(**ids: str) -> Iterator[None]:
    """Give the ids of what is done in the block to every line that is written meanwhile.

    Tasks and threads that begin in the block and copy its context count to it.
    """
    mark = _context.set({**(_context.get() or {}), **ids})
    try:
        yield
    finally:
        _context.reset(mark)


def tag_log(**ids: str) -> None:
    """Add ids to the block under way, as soon as they are known, for everything that belongs to it."""
    found = _context.get()
    if found is not None:
        found.update(ids)


def conceal(secret: str) -> None:
    """Never write this text from now on."""
    _secrets.add(secret)


def set_up_logging(
    log_format: str,
    level: str,
    process_ids: Callable[[], Mapping[str, str]] = lambda: {},
    stream: TextIO | None = None,
) -> None:
    """Write the lines of this process, and warnings of libraries among them.

    Args:
        log_format: "text" or "json".
        level: the least level of our own lines, one of `LEVELS`; those of libraries begin at "info", since
            they tell headers, and with them tokens, below it.
        process_ids: ids that hold for every line of the process that has none of its own.
        stream: where to; None for standard error.
    """
    least = logging.getLevelNamesMapping()[level.upper()]
    handler = logging.StreamHandler(stream or sys.stderr)
    handler.setFormatter(LineFormatter(log_format == "json", process_ids))
    root = logging.getLogger()
    root.handlers[:] = [handler]
    root.setLevel(max(least, logging.INFO))
    for name in OWN:
        logging.getLogger(name).setLevel(least)
    logging.captureWarnings(True)


class LineFormatter(logging.Formatter):
    """Formats a record as one line; as text, a traceback follows on indented lines."""

    def __init__(self, as_json: bool, process_ids: Callable[[], Mapping[str, str]] = lambda: {}) -> None:
        """Format as JSON or as text; see `set_up_logging`."""
        super().__init__()
        self._as_json = as_json
        self._process_ids = process_ids

    def format(self, record: logging.LogRecord) -> str:
        """The line of a record, without its end."""
        message = record.getMessage().rstrip("\n")
        if record.name.startswith("uvicorn"):
            message = _QUERY.sub("?" + CONCEALED, message)
        trace = self.formatException(record.exc_info) if record.exc_info else ""
        moment = datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds")
        line = {
            "time": moment.replace("+00:00", "Z"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": _without_secrets(message),
            **{name: _without_secrets(text) for name, text in self._ids(record).items()},
        }
        if trace:
            line["traceback"] = _without_secrets(trace)
        return json.dumps(line) if self._as_json else _text(line)

    def _ids(self, record: logging.LogRecord) -> dict[str, str]:
        """Ids of a record: its own, else those of what is being done, else those of the process."""
        found = {**self._process_ids(), **(_context.get() or {})}
        found.update({name: vars(record)[name] for name in IDS if vars(record).get(name)})
        return {name: found[name] for name in IDS if found.get(name)}


def _text(line: dict[str, str]) -> str:
    ids = " ".join(f"{name}={line[name]}" for name in IDS if name in line)
    message = line["message"] + (f" [{ids}]" if ids else "")
    head = f"{line['time']} {line['level'].upper():<7} {line['logger']}: {message.translate(_CONTROL)}"
    trace = (f"    {part.translate(_CONTROL)}" for part in line.get("traceback", "").splitlines())
    return "\n".join((head, *trace))


def _without_secrets(text: str) -> str:
    for secret in _secrets:
        text = text.replace(secret, CONCEALED)
    return _STORED_TOKEN.sub(rf"fev-\1-{CONCEALED}", text)
