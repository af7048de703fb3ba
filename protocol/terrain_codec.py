"""The base bed on the wire: lossless, so that a preview equals the solver bit for bit."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from protocol.compression import compress, decompress
from protocol.depth_codec import FloatArray
from protocol.errors import FrameError
from protocol.limits import MAX_TERRAIN_BYTES, PART_BYTES
from protocol.messages import Terrain


def encode_terrain(command_id: int, run: str, z_b: npt.ArrayLike) -> list[Terrain]:
    """A bed as `terrain` messages.

    Args:
        command_id: id of the `get_terrain` that asked.
        run: id of the run.
        z_b: bed [m, relative to the datum offset], shape [nrows, ncols].

    Returns:
        The parts in order.
    """
    bed = np.ascontiguousarray(z_b, dtype="<f4")
    packed = compress(bed.data.cast("B"))
    parts = -(-len(packed) // PART_BYTES)
    return [
        Terrain(
            id=command_id,
            run=run,
            part=part,
            parts=parts,
            shape=(bed.shape[0], bed.shape[1]),
            codec="zstd-f32",
            data=packed[part * PART_BYTES : (part + 1) * PART_BYTES],
        )
        for part in range(parts)
    ]


def decode_terrain(packed: bytes, shape: tuple[int, int]) -> FloatArray:
    """The bed, float32 of the given shape.

    Args:
        packed: data of all parts in order.
        shape: rows and columns.

    Raises:
        TooLarge: when it would pass the limits.
        FrameError: when it does not hold shape[0] x shape[1] finite values.
    """
    raw = decompress(packed, 4 * shape[0] * shape[1], MAX_TERRAIN_BYTES)
    bed = np.frombuffer(raw, dtype="<f4").reshape(shape).astype(np.float32)
    if not np.isfinite(bed).all():
        raise FrameError("A terrain holds elevations that are not finite.")
    return bed
