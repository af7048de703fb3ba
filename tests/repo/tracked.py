"""The files that git knows: what a clone, and so a user, would get."""

import subprocess
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]


def tracked_names(*folders: str) -> list[str] | None:
    """Names of the tracked files that exist, below these folders; None without git or outside a clone."""
    # safe.directory: a checkout may belong to another user, as in a container.
    command = ["git", "-c", "safe.directory=*", "ls-files", "-z", "--", *folders]
    try:
        listing = subprocess.run(
            command, cwd=REPOSITORY, capture_output=True, text=True, timeout=60, check=True
        )
    except (OSError, subprocess.CalledProcessError):
        return None
    return [name for name in listing.stdout.split("\0") if name and (REPOSITORY / name).is_file()]
