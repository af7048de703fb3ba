"""Presenting: showing one's view to the other viewers, and following somebody who does."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["FollowView", "PresentView"]


@dataclass(frozen=True)
class PresentView:
    """Show this view to all other viewers of the service from now on, or no longer."""

    on: bool = True


@dataclass(frozen=True)
class FollowView:
    """Fly along with the session that presents its view; None flies freely."""

    session: str | None = None


PresentingCommand = PresentView | FollowView
"""Any command of this family."""
