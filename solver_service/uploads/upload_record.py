"""One upload as people see it."""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

UploadStatus = Literal["receiving", "waiting", "importing", "accepted", "refused"]


@dataclass
class UploadRecord:
    """Where an upload stands.

    Attributes:
        upload: its id.
        label: who sends it.
        bytes_sent: size of the archive as the sender says it; None where it says nothing.
        status: receiving, waiting for the imports before it, importing, then accepted or refused.
        bytes_received: how much has come.
        stage: what the import does: unpacking, reading or trying.
        done: share of that stage [0 to 1].
        case: name of the case, once it is accepted.
        message: why it was refused.
        warnings: what the check found odd.
        since: when it began, in seconds since 1970.
        ended: when it was accepted or refused, in seconds since 1970; None before.
    """

    upload: str
    label: str
    bytes_sent: int | None
    status: UploadStatus = "receiving"
    bytes_received: int = 0
    stage: str = ""
    done: float = 0.0
    case: str = ""
    message: str = ""
    warnings: tuple[str, ...] = ()
    since: float = field(default_factory=time.time)
    ended: float | None = None

    @property
    def is_over(self) -> bool:
        """Whether nothing more happens."""
        return self.ended is not None

    def facts(self) -> dict[str, Any]:
        """For REST and the operator's page."""
        return asdict(self)

    def accept(self, case: str, warnings: tuple[str, ...]) -> None:
        """The case is on offer now."""
        self.status, self.case, self.warnings, self.done = "accepted", case, warnings, 1.0
        self.ended = time.time()

    def refuse(self, sentence: str) -> None:
        """The case is not taken."""
        self.status, self.message, self.ended = "refused", sentence, time.time()
