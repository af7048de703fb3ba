"""The tour of the embedded case keeps its promise: a levee on dry ground sends the water another way."""

import numpy as np

from protocol import apply_edits, rasterise_edit
from solver_service.numerics import ShallowWaterSolver
from solver_service.scenario import load_case


def test_the_levee_of_the_tour_turns_the_flood_around_the_hill() -> None:
    case = load_case("jacksboro", cell_size=60.0)
    solver = ShallowWaterSolver(case.model, case.params, "cpu")
    solver.set_water(case.initial_h)
    solver.advance_to(case.demo.time)
    drawn = solver.snapshot()
    rows, cols, _ = rasterise_edit(case.demo.edits[0], case.grid)
    assert solver.depth()[rows, cols].max() == 0.0

    solver.advance_to(1000.0)
    without = solver.depth()
    solver.restore(drawn)
    solver.replace_bed(apply_edits(case.z_b, list(case.demo.edits), case.grid).z_b)
    solver.advance_to(1000.0)
    behind = solver.depth()

    cell_km2 = (case.grid.dx / 1000.0) ** 2
    newly_wet = np.argwhere((behind > 0.3) & (without < 0.05))
    dried = np.argwhere((without > 0.3) & (behind < 0.05))
    assert len(newly_wet) * cell_km2 > 0.5
    assert len(dried) * cell_km2 > 1.0
    # What was flooded lies south of the levee; the water turns up north of it and in the west.
    levee_row = rows.mean()
    assert np.median(dried[:, 0]) < levee_row < np.median(newly_wet[:, 0])
    assert abs(solver.budget().error_relative) < 1e-6
