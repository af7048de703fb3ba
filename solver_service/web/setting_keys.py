"""Every setting of a service: what it means, what is allowed, and how its text is read; one table for all."""

from __future__ import annotations

import dataclasses
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from protocol import CHANNEL_NAMES
from protocol.limits import MAX_CELLS
from solver_service.logging_setup import LEVELS
from solver_service.web.settings import ServiceSettings

ENVIRONMENT_PREFIX = "FEV_SERVE_"

Kind = Literal["text", "integer", "number", "yes or no", "path", "texts"]
Value = str | int | float | bool | Path | tuple[str, ...]


@dataclass(frozen=True)
class SettingKey:
    """One setting.

    Attributes:
        name: its key in the settings file, the name of the field of `ServiceSettings`.
        kind: what its value is.
        meaning: one clause for people.
        flag: the option of `fev-solver serve`, or none.
        least: smallest number allowed.
        most: largest number allowed.
        pattern: what a text, or each text of a list, must match.
        allowed: the pattern in words.
    """

    name: str
    kind: Kind
    meaning: str
    flag: str | None = None
    least: float = -math.inf
    most: float = math.inf
    pattern: str = r"(?s).+"
    allowed: str = "a text that is not empty"

    @property
    def variable(self) -> str:
        """Its environment variable."""
        return f"{ENVIRONMENT_PREFIX}{self.name.upper()}"

    @property
    def default(self) -> object:
        """Its value where nobody says anything."""
        return DEFAULTS[self.name]

    @property
    def allowed_words(self) -> str:
        """What is allowed, as the end of a sentence."""
        match self.kind:
            case "yes or no":
                return "true or false"
            case "path":
                return "a path"
            case "texts":
                return f"a list, each {self.allowed} (separated by commas in the environment)"
            case "integer" | "number":
                noun = "a whole number" if self.kind == "integer" else "a number"
                if math.isfinite(self.most):
                    return f"{noun} from {self.least:.12g} to {self.most:.12g}"
                return f"{noun} of {self.least:.12g} or more"
            case "text":
                return self.allowed

    def read(self, given: object, base: Path) -> Value | None:
        """The value that is meant, or None where what is given is not allowed.

        Args:
            given: a value of TOML or of the command line.
            base: the folder to which paths are relative.
        """
        match self.kind:
            case "yes or no":
                return given if isinstance(given, bool) else None
            case "path" if isinstance(given, str | Path) and str(given):
                return base / Path(given).expanduser()
            case "texts" if isinstance(given, list | tuple):
                fit = all(isinstance(text, str) and re.fullmatch(self.pattern, text) for text in given)
                return tuple(given) if fit else None
            case "integer" if isinstance(given, int) and not isinstance(given, bool):
                return given if self.least <= given <= self.most else None
            case "number" if isinstance(given, int | float) and not isinstance(given, bool):
                number = float(given)
                return number if math.isfinite(number) and self.least <= number <= self.most else None
            case "text" if isinstance(given, str) and re.fullmatch(self.pattern, given):
                return given
        return None

    def read_text(self, given: str, base: Path) -> Value | None:
        """The value that a text of the environment means, or None where it is not allowed."""
        typed: object = given
        try:
            if self.kind == "integer":
                typed = int(given)
            elif self.kind == "number":
                typed = float(given)
        except ValueError:
            return None
        if self.kind == "yes or no":
            typed = {"true": True, "false": False}.get(given.lower())
        elif self.kind == "texts":
            typed = [part.strip() for part in given.split(",")] if given.strip() else []
        return self.read(typed, base)


def _limit(name: str, meaning: str) -> SettingKey:
    """A limit of every token that says nothing itself."""
    return SettingKey(name, "integer", meaning, f"--{name.replace('_', '-')}", 0)


KEYS: tuple[SettingKey, ...] = (
    SettingKey("host", "text", "address to listen on", "--host"),
    SettingKey("port", "integer", "TCP port; 0 takes a free one", "--port", 0, 65535),
    SettingKey("data_dir", "path", "folder of runs, frames and checkpoints", "--data-dir"),
    SettingKey("token_file", "path", "file with the operator's token of this machine", "--token-file"),
    SettingKey("ready_file", "path", "file for the ready line as well", "--ready-file"),
    SettingKey("stop_with_stdin", "yes or no", "end when standard input closes", "--stop-with-stdin"),
    SettingKey("cases", "texts", "cases offered beside the known, names or paths", "--case"),
    SettingKey(
        "device",
        "text",
        'device of runs that ask for "auto"',
        "--device",
        pattern=r"auto|cpu|cuda(:[0-9]{1,3})?",
        allowed="auto, cpu, cuda or cuda:N",
    ),
    SettingKey("threads", "integer", "solver threads on the CPU; all cores by default", "--threads", 1, 4096),
    SettingKey(
        "allowed_origins",
        "texts",
        "web origins that are served beside the own address",
        "--allow-origin",
    ),
    SettingKey("tls_certificate", "path", "file with the certificate chain (PEM)", "--tls-certificate"),
    SettingKey("tls_key", "path", "file with the key of the certificate (PEM)", "--tls-key"),
    SettingKey("ring_bytes", "integer", "memory of a worker for recent states [bytes]", least=1 << 20),
    SettingKey("checkpoint_interval_s", "number", "wall time between checkpoints [s]", least=0.001, most=1e6),
    SettingKey("spare_workers", "integer", "warm workers that stand by", least=0, most=6),
    SettingKey(
        "restart_attempts",
        "integer",
        "how often a run whose worker died is taken up by itself",
        "--restart-attempts",
        0,
        1000,
    ),
    SettingKey(
        "restart_within_s", "number", "the time in which these attempts count [s]", least=0.001, most=1e9
    ),
    SettingKey("store_bytes", "integer", "budget of frames and checkpoints [bytes]", "--store-bytes", 1),
    SettingKey("reserve_bytes", "integer", "room on the disk that is left to others [bytes]", least=0),
    SettingKey("upload_bytes", "integer", "most bytes of an uploaded archive", least=0, most=4 << 30),
    SettingKey("upload_cells", "integer", "most cells of an uploaded case", least=1, most=MAX_CELLS),
    SettingKey(
        "upload_memory_bytes",
        "integer",
        "most memory of the process that imports a case [bytes]",
        least=1 << 30,
    ),
    SettingKey("upload_time_s", "number", "most time of an import [s]", least=1, most=86_400),
    SettingKey(
        "channels",
        "texts",
        "what runs may keep of a frame beside its depth",
        pattern="|".join(CHANNEL_NAMES),
        allowed=" or ".join(CHANNEL_NAMES),
    ),
    SettingKey(
        "worker_silence_s",
        "number",
        "how long a worker may give no sign at all before another takes its run [s]",
        least=2.0,
        most=1e6,
    ),
    SettingKey(
        "worker_stall_s",
        "number",
        "how long it may do one and the same thing, such as a step or a compilation [s]",
        least=2.0,
        most=1e6,
    ),
    SettingKey(
        "log_format",
        "text",
        "form of the log lines on standard error",
        "--log-format",
        pattern="text|json",
        allowed="text or json",
    ),
    SettingKey(
        "log_level",
        "text",
        "least level of the log lines",
        "--log-level",
        pattern="|".join(LEVELS),
        allowed=", ".join(LEVELS),
    ),
    _limit("max_runs", "runs that a token may keep"),
    _limit("max_cells", "cells that the runs of a token may compute at the same time"),
    _limit("max_gpu_bytes", "GPU memory that the runs of a token may take [bytes]"),
    _limit("max_disk_bytes", "room that frames, checkpoints and uploads of a token may take [bytes]"),
    _limit("max_edits_per_s", "changes of edits that a token may make within a second"),
    _limit("max_viewers", "streams that a token may have open"),
)
"""All settings, in the order in which they are told."""

DEFAULTS: dict[str, object] = {
    field.name: getattr(ServiceSettings(data_dir=Path()), field.name)
    for field in dataclasses.fields(ServiceSettings)
}
