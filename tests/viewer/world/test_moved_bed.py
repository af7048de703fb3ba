import numpy as np

from viewer.world import MovedBed, bed_with, blended_bed

BED = np.arange(20, dtype=np.float32).reshape(4, 5)


def moved(cells: list[int], z_b: list[float]) -> MovedBed:
    at = np.array(cells, np.int64)
    return MovedBed(at, np.array(z_b, np.float32), BED.ravel()[at])


def test_the_bed_is_laid_over_a_copy() -> None:
    laid = bed_with(BED, moved([6, 13], [-1.0, -2.0]))

    assert (laid[1, 1], laid[2, 3]) == (-1.0, -2.0)
    assert (laid != BED).sum() == 2
    assert BED[1, 1] == 6.0


def test_the_rectangle_holds_every_cell() -> None:
    assert moved([6, 13], [0.0, 0.0]).rect(5) == (1, 1, 3, 4)
    assert moved([], []).rect(5) is None


def test_an_edit_not_computed_yet_keeps_its_height_above_the_moved_bed() -> None:
    part = moved([6, 13], [0.7, 3.3])
    ground = np.array([6.0, 13.0 + 4.0], np.float32)

    assert part.on(ground).tolist() == [
        np.float32(0.7),
        np.float32(17.0) + (np.float32(3.3) - np.float32(13.0)),
    ]


def test_between_two_frames_a_gap_grows_steadily_and_wider() -> None:
    first, second = moved([6], [4.0]), moved([6, 7], [2.0, 3.0])
    half = blended_bed(first, second, 0.5)
    opening = blended_bed(None, second, 0.25)

    assert half is not None
    assert opening is not None
    assert half.cells.tolist() == [6, 7]
    assert half.z_b.tolist() == [3.0, 5.0]
    assert half.before.tolist() == [6.0, 7.0]
    assert opening.z_b.tolist() == [5.0, 6.0]


def test_at_a_frame_the_bed_is_that_of_the_frame_itself() -> None:
    first, second = moved([6], [4.0]), moved([6, 7], [2.0, 3.0])

    assert blended_bed(first, second, 0.0) is first
    assert blended_bed(first, second, 1.0) is second
    assert blended_bed(first, first, 0.3) is first
    assert blended_bed(None, None, 0.3) is None
    assert blended_bed(None, second, 0.0) is None
