"""Golden bytes: what every example looks like on the wire, as hexadecimal text.

They are kept for ever: a change here is a change of the protocol. A new message gets its file by

    python -m tests.protocol.golden
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


def renew() -> None:
    FOLDER.mkdir(exist_ok=True)
    for name, message in EXAMPLES.items():
        (FOLDER / f"{name}.hex").write_text(to_hex(pack(message)), encoding="ascii")


if __name__ == "__main__":
    renew()
