"""What an upload may take."""

from __future__ import annotations

from dataclasses import dataclass, field

from solver_service.uploads.import_messages import ImportLimits


@dataclass(frozen=True)
class UploadRules:
    """What uploads may take.

    Attributes:
        archive_bytes: most bytes of an archive.
        limits: what its import may take.
        reserve_bytes: room on the disk that is left to others [bytes].
    """

    archive_bytes: int = 1 << 30
    limits: ImportLimits = field(default_factory=ImportLimits)
    reserve_bytes: int = 256 << 20
