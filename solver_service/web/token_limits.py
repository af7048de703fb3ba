"""How much the holder of a token may take; the same six limits for a token and for the whole service."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from solver_service.errors import AccessError

LARGEST = float(1 << 53)
"""What a JSON number still holds exactly."""


@dataclass(frozen=True)
class TokenLimits:
    """Six limits; None for what is not limited (of a service) or not said (of a token).

    Attributes:
        max_runs: runs that are kept, whatever their status.
        max_cells: cells of all runs that compute at the same time.
        max_gpu_bytes: memory of all runs that compute on a GPU, or wait with their water on it [bytes].
        max_disk_bytes: frames, checkpoints and uploaded cases [bytes].
        max_edits_per_s: changes of edits within one second.
        max_viewers: streams that are open at the same time.

    Raises:
        AccessError: a limit is below 0 or no number.
    """

    max_runs: int | None = None
    max_cells: int | None = None
    max_gpu_bytes: int | None = None
    max_disk_bytes: int | None = None
    max_edits_per_s: int | None = None
    max_viewers: int | None = None

    def __post_init__(self) -> None:
        for name, value in self.items():
            if value is not None and not (math.isfinite(value) and 0 <= value <= LARGEST):
                raise AccessError(f"{name} is {value!r}; a whole number from 0 to {LARGEST:.0f} is allowed")

    def items(self) -> tuple[tuple[str, int | None], ...]:
        """Every limit by its name."""
        return tuple((each.name, getattr(self, each.name)) for each in fields(self))

    def over(self, defaults: TokenLimits) -> TokenLimits:
        """These limits, and where nothing is said the defaults."""
        return TokenLimits(
            **{name: getattr(defaults, name) if value is None else value for name, value in self.items()}
        )


NAMES = tuple(each.name for each in fields(TokenLimits))
