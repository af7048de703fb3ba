"""Golden bytes: what every example looks like on the wire, as hexadecimal text.

They are kept for ever: a change here is a change of the protocol. Examples that have no file yet get one by

    python -m tests.protocol.golden

and a file that is there is never written again; who means to change one deletes it first. The files in
`golden/compressed` hold zstd data, which may differ between its releases: they are only ever read.
"""

from pathlib import Path

from protocol import pack
from tests.protocol.examples import EXAMPLES

FOLDER = Path(__file__).parent / "golden"
LINE_LENGTH = 96


def to_hex(data: bytes) -> str:
    text = data.hex()
    lines = [text[at : at + LINE_LENGTH] for at in range(0, len(text), LINE_LENGTH)]
    return "\n".join(lines) + "\n"


def read_hex(name: str) -> bytes:
    return bytes.fromhex((FOLDER / f"{name}.hex").read_text(encoding="ascii"))


def write_missing() -> None:
    FOLDER.mkdir(exist_ok=True)
    for name, message in EXAMPLES.items():
        path = FOLDER / f"{name}.hex"
        if not path.exists():
            path.write_text(to_hex(pack(message)), encoding="ascii")


if __name__ == "__main__":
    write_missing()
