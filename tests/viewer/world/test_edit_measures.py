import tracemalloc

import numpy as np
import pytest

from protocol import EditArea, EditLine, EditType, GridGeometry, Operation, apply_edits
from viewer.world import measure_edits

GRID = GridGeometry(60, 80, 10.0, 1000.0, 2000.0, datum_offset=50.0)
FLAT = np.full((60, 80), 5.0, np.float32)


def line(operation: Operation = Operation.raise_, level: float | None = None) -> EditLine:
    return EditLine(
        id="line",
        vertices=((1100.0, 2100.0), (1400.0, 2100.0), (1400.0, 2500.0)),
        width=30.0,
        operation=operation,
        type=EditType.modulate if level is None else EditType.replace,
        magnitude=2.0,
        level=level,
    )


def test_length_and_volume_of_a_levee_are_those_of_its_cells() -> None:
    (measure,) = measure_edits(FLAT, [line()], GRID)
    raised = apply_edits(FLAT, [line()], GRID).z_b - FLAT

    assert measure.length == pytest.approx(700.0)
    assert measure.volume == pytest.approx(float(raised.sum()) * 100.0)
    assert 700.0 * 30.0 * 2.0 <= measure.volume <= 700.0 * 40.0 * 2.0 * 1.05
    assert measure.rows.size == np.count_nonzero(raised)


def test_a_trench_is_cut_and_raises_no_cell() -> None:
    (measure,) = measure_edits(FLAT, [line(Operation.lower)], GRID)

    assert measure.volume < 0.0
    assert measure.rows.size == 0


def test_an_edit_is_measured_on_the_ground_that_those_before_it_left() -> None:
    crest = line(level=58.0)  # 3 m above the ground
    first, second = measure_edits(FLAT, [line(), crest], GRID)

    assert second.volume == pytest.approx(0.5 * first.volume)  # 1 m is left to fill
    assert measure_edits(FLAT, [crest, crest], GRID)[1].volume == 0.0


def test_the_length_of_an_area_is_that_of_its_border() -> None:
    area = EditArea(
        id="area",
        vertices=((1100.0, 2100.0), (1300.0, 2100.0), (1300.0, 2200.0), (1100.0, 2200.0)),
        operation=Operation.raise_,
        type=EditType.modulate,
        magnitude=1.0,
    )

    assert measure_edits(FLAT, [area], GRID)[0].length == pytest.approx(600.0)


def test_measuring_leaves_the_bed_as_it_was_and_copies_no_more_than_the_edits_cover() -> None:
    grid = GridGeometry(2000, 2000, 1.0)
    bed = np.zeros((2000, 2000), np.float32)
    small = EditLine(
        "small", ((1000.0, 1000.0), (1040.0, 1020.0)), 3.0, Operation.raise_, EditType.modulate, 2.0
    )
    tracemalloc.start()
    (measure,) = measure_edits(bed, [small], grid)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()

    assert measure.volume > 0.0
    assert not bed.any()
    assert peak < bed.nbytes / 20
