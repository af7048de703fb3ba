from itertools import pairwise

import numpy as np
import pytest

from viewer.lod import BlockTiling, block_errors, edge_errors
from viewer.lod.edge_errors import _strip_error


def fitted_strip_error(z: np.ndarray, edge: int, inner: int, level: int, coarser: int) -> float:
    """One row of squares the long way: build the triangles, look up each vertex that lies in one."""
    step, last = 1 << level, z.shape[1] - 1
    kept = [*range(0, last, step), last]

    def fit(c: int) -> int:
        return c if c == last else (c >> coarser) << coarser

    worst = 0.0
    for c0, c1 in pairwise(kept):
        e0, e1, i0, i1 = (edge, fit(c0)), (edge, fit(c1)), (inner, c0), (inner, c1)
        halves = ((e0, e1, i1), (e0, i1, i0)) if inner > edge else ((i0, i1, e1), (i0, e1, e0))
        for corners in halves:
            matrix = np.array([[r, c, 1.0] for r, c in corners]).T
            if abs(np.linalg.det(matrix)) < 1e-9:
                continue
            for r in range(min(edge, inner), max(edge, inner) + 1):
                for c in range(last + 1):
                    weights = np.linalg.solve(matrix, [r, c, 1.0])
                    if weights.min() > -1e-9:
                        surface = sum(w * z[p] for w, p in zip(weights, corners, strict=True))
                        worst = max(worst, abs(float(surface - z[r, c])))
    return worst


@pytest.mark.parametrize(("edge", "toward"), [(0, 1), (16, -1)])
@pytest.mark.parametrize("width", [17, 14])
def test_strips_are_those_of_the_triangles_drawn(
    rng: np.random.Generator, edge: int, toward: int, width: int
) -> None:
    z = rng.normal(size=(17, width)).astype(np.float32)
    for level in range(4):
        for coarser in range(level + 1, 5):
            inner = edge + toward * (1 << level)
            expected = fitted_strip_error(z, edge, inner, level, coarser)
            found = _strip_error(z, BlockTiling(17, width, 17), edge, inner, level, coarser)
            assert found[0] == pytest.approx(expected, abs=1e-5)


def test_a_flat_block_beside_a_steep_one_is_charged_for_the_shared_strip() -> None:
    # Flat up to the shared edge; behind it waves that grow over the first columns.
    rows, behind = np.meshgrid(np.arange(33), np.clip(np.arange(65) - 32, 0, 4), indexing="ij")
    z = (3.0 * behind * np.sin(2.0 * np.pi * rows / 16.0)).astype(np.float32)
    tiling = BlockTiling(33, 65)
    errors = block_errors(z, tiling)
    charges = edge_errors(z, tiling, errors)

    assert errors[:, 0, 0].max() == 0.0
    assert charges[4, 0, 0] > 0.5
    assert charges[:, 0, 1].max() == 0.0


def test_a_charge_never_exceeds_what_the_steep_block_itself_would_err(rng: np.random.Generator) -> None:
    z = rng.normal(size=(97, 97)).astype(np.float32)
    tiling = BlockTiling(97, 97)
    errors = block_errors(z, tiling)

    assert (
        edge_errors(z, tiling, errors)
        <= np.maximum.accumulate(errors, axis=0).max(axis=(1, 2))[:, None, None]
    ).all()


def test_a_plane_charges_nothing() -> None:
    rows, cols = np.meshgrid(np.arange(65.0), np.arange(97.0), indexing="ij")
    z = (0.5 * rows - 0.25 * cols).astype(np.float32)
    tiling = BlockTiling(65, 97)

    assert edge_errors(z, tiling, block_errors(z, tiling)).max() < 1e-5


def test_the_transposed_ground_has_the_transposed_charges(rng: np.random.Generator) -> None:
    z = rng.normal(size=(65, 97)).astype(np.float32)
    tiling, turned = BlockTiling(65, 97), BlockTiling(97, 65)
    charges = edge_errors(z, tiling, block_errors(z, tiling))
    other = np.ascontiguousarray(z.T)

    assert charges == pytest.approx(
        edge_errors(other, turned, block_errors(other, turned)).transpose(0, 2, 1)
    )
