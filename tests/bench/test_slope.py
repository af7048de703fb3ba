import numpy as np
import pytest

from bench.slope import slope_of

TIMES = np.arange(400) * 0.5


def noise(rng: np.random.Generator, size: float) -> np.ndarray:
    return size * rng.standard_normal(len(TIMES))


def test_a_leak_is_found_in_noise_and_its_size_lies_between_the_bounds(rng: np.random.Generator) -> None:
    found = slope_of(TIMES, 1000.0 + 0.2 * TIMES + noise(rng, 5.0))
    assert found.exceeds(20.0)
    assert found.least < 0.2 * TIMES[-1] < found.most


def test_noise_steps_back_and_forth_and_a_tiny_leak_do_not_count(rng: np.random.Generator) -> None:
    assert not slope_of(TIMES, 1000.0 + noise(rng, 50.0)).exceeds(20.0)
    assert not slope_of(TIMES, 1000.0 + 100.0 * (np.sin(TIMES / 7.0) > 0.0)).exceeds(20.0)
    assert not slope_of(TIMES, 1000.0 + 0.02 * TIMES + noise(rng, 1.0)).exceeds(20.0)


def test_what_shrinks_does_not_grow(rng: np.random.Generator) -> None:
    found = slope_of(TIMES, 1000.0 - TIMES + noise(rng, 5.0))
    assert found.growth < 0.0
    assert not found.exceeds(0.0)


def test_noise_alone_exceeds_nothing_in_at_most_one_of_twenty(rng: np.random.Generator) -> None:
    grows = [slope_of(TIMES, noise(rng, 5.0)).exceeds(0.0) for _ in range(200)]
    assert sum(grows) < 20, "the bounds are not those of the confidence that is said"
    assert sum(grows) > 0


def test_too_few_samples_are_refused() -> None:
    with pytest.raises(ValueError, match="5 samples"):
        slope_of(range(5), range(5))
