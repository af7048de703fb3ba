import numpy as np

from solver_service.runs.state_ring import StateRing
from solver_service.store import StoredState

NBYTES = 64 * 64 * 4


def state(time: float, rng: np.random.Generator) -> StoredState:
    return StoredState(time, int(time), {"h": rng.random((64, 64)).astype(np.float32)}, {"dt": time / 3.0})


def test_a_packed_state_comes_back_bit_for_bit(rng: np.random.Generator) -> None:
    ring = StateRing(1 << 30)
    kept = state(7.0, rng)
    ring.add("r1", kept)
    assert ring.pack_one()
    assert not ring.pack_one()
    found = ring.latest("r1", 8.0)
    assert found is not None
    assert (found.time, found.step_count, found.scalars) == (7.0, 7, kept.scalars)
    np.testing.assert_array_equal(found.arrays["h"], kept.arrays["h"])


def test_the_newest_state_at_or_before_a_time_of_the_right_run_is_found(rng: np.random.Generator) -> None:
    ring = StateRing(1 << 30)
    for time in (1.0, 3.0, 2.0):
        ring.add("r1", state(time, rng))
    ring.add("r2", state(2.5, rng))
    assert [ring.latest("r1", t).time for t in (1.0, 2.9, 9.0)] == [1.0, 2.0, 3.0]  # type: ignore[union-attr]
    assert ring.latest("r1", 0.5) is None
    assert ring.latest("r3", 9.0) is None


def test_over_budget_the_time_line_is_thinned_evenly_and_the_newest_stays(rng: np.random.Generator) -> None:
    ring = StateRing(8 * NBYTES)
    for time in range(65):
        ring.add("r1", state(float(time), rng))
    times = ring.times("r1")
    assert len(times) == 8
    assert times[-1] == 64.0
    assert ring.size_bytes <= 8 * NBYTES
    assert max(np.diff([0.0, *times])) <= 3 * 64.0 / 8


def test_a_state_of_the_same_time_replaces_the_one_before(rng: np.random.Generator) -> None:
    ring = StateRing(1 << 30)
    ring.add("r1", state(1.0, rng))
    second = state(1.0, rng)
    ring.add("r1", second)
    assert ring.times("r1") == [1.0]
    found = ring.latest("r1", 1.0)
    assert found is not None
    np.testing.assert_array_equal(found.arrays["h"], second.arrays["h"])


def test_one_state_larger_than_the_budget_is_kept(rng: np.random.Generator) -> None:
    ring = StateRing(10)
    ring.add("r1", state(1.0, rng))
    assert ring.times("r1") == [1.0]
