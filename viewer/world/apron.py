"""Ground continued past the data, so that what is drawn there is level and cheap and hides nothing.

A case may cover a part of its raster only; the rest is walled off at some height. Drawn as it is, that wall
would stand before the flood, and its cliff would ask for full detail all round the data.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

__all__ = ["continued"]

Array = npt.NDArray[np.float32]


def continued(z: Array, outside: npt.NDArray[np.bool_]) -> Array:
    """The ground with smooth values outside of the data; inside it keeps every value.

    Averages over ever larger squares are taken where there is data, and handed down again where there is none
    (push and pull: Gortler et al., "The Lumigraph", 1996).

    Args:
        z: elevation [m], shape [nrows, ncols].
        outside: cells without data, of the same shape.

    Returns:
        elevation [m], of the same shape; zero everywhere where there is no data at all.
    """
    weights = (~outside).astype(np.float32)
    values = np.where(outside, np.float32(0.0), z).astype(np.float32)
    levels = [(values, weights)]
    while max(weights.shape) > 1 and not weights.all():
        total, weight = _summed(values * weights), _summed(weights)
        values = np.divide(total, weight, out=np.zeros_like(total), where=weight > 0.0)
        # A square counts as known however little of it is, or the border would be averaged far into it.
        weights = np.minimum(weight, np.float32(1.0))
        levels.append((values, weights))
    filled, _ = levels.pop()
    while levels:
        values, weights = levels.pop()
        coarse = _doubled(filled)[: values.shape[0], : values.shape[1]]
        filled = np.where(weights > 0.0, values, coarse)
    return np.ascontiguousarray(filled, dtype=np.float32)


def _summed(values: Array) -> Array:
    """Sums over squares of two by two; an odd last row or column stands alone."""
    rows = np.add.reduceat(values, np.arange(0, values.shape[0], 2), axis=0)
    return np.asarray(np.add.reduceat(rows, np.arange(0, values.shape[1], 2), axis=1), dtype=np.float32)


def _doubled(values: Array) -> Array:
    """Twice as many rows and columns, linear between the middles of the squares."""
    for axis in (0, 1):
        before, after = np.roll(values, 1, axis), np.roll(values, -1, axis)
        first, last = [slice(None)] * 2, [slice(None)] * 2
        first[axis], last[axis] = slice(0, 1), slice(-1, None)
        before[tuple(first)], after[tuple(last)] = values[tuple(first)], values[tuple(last)]
        pair = np.stack([0.75 * values + 0.25 * before, 0.75 * values + 0.25 * after], axis=axis + 1)
        shape = list(values.shape)
        shape[axis] *= 2
        values = pair.reshape(shape)
    return values
