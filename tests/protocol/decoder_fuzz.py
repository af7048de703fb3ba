"""Feeds the decoders of both peers with bytes that nobody would send, within a memory that bombs would burst.

    python -m tests.protocol.decoder_fuzz 100000

for so many inputs to each decoder; ends with 1 and the smallest input at the first one that is neither
decoded nor refused in words. Inputs are random bytes, and golden messages with bytes changed, cut out,
repeated, or replaced by headers that promise gigabytes, or with other values in their fields.
"""

import argparse
import copy
import json
import resource
import sys
from collections.abc import Callable
from typing import Any

import msgpack
import numpy as np
import psutil
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import protocol as p
from protocol.compression import compress, decompress
from tests.protocol.golden import FOLDER

ROOM_BYTES = 256 << 20
"""What decoding may take beside the interpreter and its libraries."""
GOLDEN = [bytes.fromhex(path.read_text(encoding="ascii")) for path in sorted(FOLDER.rglob("*.hex"))]
WELCOME = p.Welcome(protocol=p.PROTOCOL_VERSION, server="s", version="1", session="s1")
LAYOUT = p.BlockLayout(34, 34)
BED = compress(np.linspace(0.0, 9.0, 34 * 34, dtype=np.float32).tobytes())
PROMISES = (
    b"\xdd\xff\xff\xff\xff",  # an array of 4 G items
    b"\xdf\xff\xff\xff\xff",  # a map
    b"\xdb\xff\xff\xff\xff",  # a string
    b"\xc6\xff\xff\xff\xff",  # bytes
    b"\xc9\xff\xff\xff\xff\x01",  # an extension
    b"\x91" * 2000,  # lists within lists
    b"\x28\xb5\x2f\xfd\xa4\x00\x00\x00\x80",  # a zstd frame of 2 GB
    b"\xcf\xff\xff\xff\xff\xff\xff\xff\xff",  # the largest number
    b"\xcb\x7f\xf8\x00\x00\x00\x00\x00\x00",  # not a number
)


@st.composite
def damaged(draw: st.DrawFn, messages: list[bytes]) -> bytes:
    """A golden message that something happened to, once or more often."""
    data = draw(st.sampled_from(messages))
    for _ in range(draw(st.integers(1, 4))):
        begin = draw(st.integers(0, len(data)))
        end = min(begin + draw(st.integers(0, 12)), len(data))
        new = draw(st.one_of(st.sampled_from(PROMISES), st.binary(max_size=8), st.just(data[begin:end] * 9)))
        data = data[:begin] + new + data[end:]
    return data


VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**63), 2**64 - 1),
    st.floats(),
    st.text(max_size=40),
    st.binary(max_size=40),
    st.sampled_from([[], {}, [[]], [1] * 5000, {"op": "x"}, "x" * 9000, b"x" * 9000, [[1e300, 0.0]] * 40]),
)


def leaves(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The paths to everything in a message."""
    found = [path] if path else []
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        found += leaves(inner, (*path, key))
    return found


@st.composite
def altered(draw: st.DrawFn, messages: list[bytes]) -> bytes:
    """A golden message as it is, or whole again with other values, or with bytes of a payload changed."""
    message = msgpack.unpackb(draw(st.sampled_from(messages)))
    for _ in range(draw(st.integers(0, 2))):
        path = draw(st.sampled_from(leaves(message)))
        place = message
        for key in path[:-1]:
            place = place[key]
        old = place[path[-1]]
        new = copy.deepcopy(draw(VALUES))  # the drawn lists are shared
        if isinstance(old, bytes) and old and draw(st.booleans()):
            at = draw(st.integers(0, len(old) - 1))
            new = old[:at] + draw(st.binary(min_size=1, max_size=1)) + old[at + 1 :]
        place[path[-1]] = new
        if not isinstance(message, dict) or not message:
            break
    return bytes(msgpack.packb(message))


def serve(data: bytes) -> None:
    session = p.ServerSession()
    session.receive(p.pack(p.Hello()))
    session.send(WELCOME)
    session.receive(data)


def view(data: bytes) -> None:
    session = p.ClientSession("fuzz")
    session.open()
    session.receive(p.pack(WELCOME))
    session.receive(data)


def show(data: bytes) -> None:
    p.FrameDecoder(LAYOUT).decode(p.unpack_frame(data))


def open_terrain(data: bytes) -> None:
    p.decode_terrain(data, (34, 34))


def naive(data: bytes) -> None:
    """What a decoder must not do: believe a length. Asked for by name, to see that it is found out."""
    bytes(int.from_bytes(data[:4].ljust(4, b"\xff"), "big"))


DECODERS: dict[str, Callable[[bytes], object]] = {
    "unpack_client": p.unpack_client,
    "unpack_server": p.unpack_server,
    "unpack_channel": p.unpack_channel,
    "server_session": serve,
    "client_session": view,
    "frame": show,
    "terrain": open_terrain,
    "decompress": lambda data: decompress(data, 4 * 34 * 34, 1 << 20),
}


def accepts(decode: Callable[[bytes], object], data: bytes) -> bool:
    try:
        decode(data)
    except p.ProtocolError:
        return False
    return True


def feed(name: str, decode: Callable[[bytes], object], count: int) -> None:
    """Give a decoder so many inputs.

    Raises:
        Exception: whatever it raises that is no `ProtocolError`.
    """
    refused = 0
    messages = [data for data in GOLDEN if accepts(decode, data)]
    changed = altered(messages) if messages else st.just(BED)
    inputs = st.one_of(changed, changed, damaged(messages or [BED]), st.binary(max_size=4096))

    @settings(max_examples=count, deadline=None, database=None, suppress_health_check=list(HealthCheck))
    @given(inputs)
    def each(data: bytes) -> None:
        nonlocal refused
        refused += not accepts(decode, data)

    each()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(
        json.dumps({"decoder": name, "inputs": count, "refused": refused, "peak_mib": peak >> 10}), flush=True
    )


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("inputs", type=int)
    parser.add_argument("--decoder", choices=[*DECODERS, naive.__name__])
    asked = parser.parse_args(arguments)
    limit = psutil.Process().memory_info().vms + ROOM_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    chosen = {asked.decoder: {**DECODERS, "naive": naive}[asked.decoder]} if asked.decoder else DECODERS
    for name, decode in chosen.items():
        feed(name, decode, asked.inputs)


if __name__ == "__main__":
    main(sys.argv[1:])
