"""The protocol's name, its versions and what a peer can do."""

from __future__ import annotations

from collections.abc import Sequence

from protocol.errors import VersionMismatch

PROTOCOL_VERSION = "fev.v1"
"""Name of the version spoken here; also the websocket subprotocol, refused when it is not offered."""

SUPPORTED_VERSIONS: tuple[str, ...] = (PROTOCOL_VERSION,)
"""Every version this build can speak, best first."""

CAPABILITIES: tuple[str, ...] = ("depth", "edits", "area_edits", "recalculate", "replay")
"""What this build can do; a peer ignores names it does not know."""


def negotiate(versions: Sequence[str]) -> str:
    """Choose the best version that both peers speak.

    Args:
        versions: versions the client offers.

    Returns:
        The chosen version.

    Raises:
        VersionMismatch: when there is none in common.
    """
    for version in SUPPORTED_VERSIONS:
        if version in versions:
            return version
    raise VersionMismatch(
        f"The client offers the protocol versions {', '.join(versions) or 'none'};"
        f" this service speaks {', '.join(SUPPORTED_VERSIONS)}."
    )
