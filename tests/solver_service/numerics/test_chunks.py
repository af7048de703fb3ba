"""Chunks cover the active tiles and nothing else, each cell once."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from solver_service.numerics.chunks import cut_chunks, deal_chunks
from solver_service.numerics.fields import TILE


@given(
    nrows=st.integers(1, 120),
    ncols=st.integers(1, 200),
    threads=st.integers(1, 5),
    widest=st.sampled_from([32, 64, 512]),
    seed=st.integers(0, 2**32 - 1),
    density=st.floats(0.0, 1.0),
)
def test_every_active_cell_is_in_exactly_one_chunk(nrows, ncols, threads, widest, seed, density):
    mask = np.random.default_rng(seed).random((-(-nrows // TILE), -(-ncols // TILE))) < density
    covered = np.zeros((nrows, ncols), int)
    chunks = cut_chunks(mask, nrows, ncols, threads, widest)
    for row0, row1, col0, col1 in chunks:
        assert col1 - col0 <= widest
        covered[row0:row1, col0:col1] += 1
    expected = np.kron(mask, np.ones((TILE, TILE), int))[:nrows, :ncols]
    assert np.array_equal(covered, expected)
    shares = deal_chunks(chunks, threads)
    assert shares.shape == (threads + 1,)
    assert (shares[0], shares[-1]) == (0, len(chunks))
    assert (np.diff(shares) >= 0).all()
