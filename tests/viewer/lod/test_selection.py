import math
from collections.abc import Callable

import numpy as np
import pytest

from viewer.lod import (
    BlockSelector,
    BlockTiling,
    Selection,
    SwitchTable,
    block_bounds,
    block_errors,
    pixels_per_slope,
    screen_error_factor,
)
from viewer.world import Camera, Heightfield, overview

SIZE = (640, 400)


class Scene:
    def __init__(self, field: Heightfield, block_size: int = 33) -> None:
        self.field = field
        self.tiling = BlockTiling(*field.z_b.shape, block_size)
        self.errors = block_errors(field.z_b, self.tiling)
        self.bounds = block_bounds(field.z_b, self.tiling)
        self.selector = BlockSelector(self.tiling, field.grid.dx, SwitchTable(self.errors), self.bounds)

    def boxes(self) -> np.ndarray:
        """Lowest and highest corner of each block in the world, [n, 2, 3]."""
        grid, tiling, frame = self.field.grid, self.tiling, self.field.frame
        boxes = []
        for row in range(tiling.block_rows):
            for col in range(tiling.block_cols):
                west, south = grid.center(tiling.row_start[row], tiling.col_start[col])
                east, north = grid.center(tiling.row_end[row], tiling.col_end[col])
                low = frame.to_world(west, north, self.bounds.z_min[row, col])
                high = frame.to_world(east, south, self.bounds.z_max[row, col])
                boxes.append([low, high])
        return np.array(boxes)


@pytest.fixture
def scene(hilly: Heightfield) -> Scene:
    return Scene(hilly)


CAMERAS = [
    overview(3210.0, 2570.0, 50.0),
    Camera((200.0, 40.0, 100.0), 400.0, 1.0, 0.3),
    Camera((-900.0, 40.0, 700.0), 150.0, -2.0, 0.15),
    Camera((0.0, 0.0, 0.0), 1500.0, 0.0, math.pi / 2),
]


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("tau", [1.0, 2.0, 8.0])
def test_levels_equal_those_found_block_by_block(scene: Scene, camera: Camera, tau: float) -> None:
    selection = scene.selector.select(camera, scene.field.frame, SIZE, tau)
    scale = pixels_per_slope(SIZE[1], camera.fov_y)
    scale *= screen_error_factor(camera.elevation, camera.fov_y, SIZE[0] / SIZE[1])
    for block, (low, high) in enumerate(scene.boxes()):
        nearest = np.clip(camera.eye, low, high)
        distance = float(np.linalg.norm(nearest - camera.eye))
        row, col = divmod(block, scene.tiling.block_cols)
        # Rounding of float32 distances may move a block that sits on a switch distance.
        for slack in (1.0 - 1e-4, 1.0, 1.0 + 1e-4):
            level = 0
            for candidate in range(1, scene.tiling.level_count):
                if scene.errors[: candidate + 1, row, col].max() * scale <= tau * distance * slack:
                    level = candidate
            if level == selection.level[block]:
                break
        assert level == selection.level[block]


@pytest.mark.parametrize("camera", CAMERAS)
def test_a_block_with_a_vertex_in_view_is_never_culled(scene: Scene, camera: Camera) -> None:
    selection = scene.selector.select(camera, scene.field.frame, SIZE, 2.0)
    matrix = camera.projection(SIZE[0] / SIZE[1], 0.5, 1e6) @ camera.view_matrix()
    grid, tiling = scene.field.grid, scene.tiling
    culled = 0
    for block in np.flatnonzero(~selection.visible):
        row, col = divmod(int(block), tiling.block_cols)
        rows = np.arange(tiling.row_start[row], tiling.row_end[row] + 1)
        cols = np.arange(tiling.col_start[col], tiling.col_end[col] + 1)
        r, c = (a.ravel() for a in np.meshgrid(rows, cols, indexing="ij"))
        places = np.column_stack(
            [grid.x0 + (c + 0.5) * grid.dx, grid.y0 + (r + 0.5) * grid.dx, scene.field.z_b[r, c]]
        )
        clip = np.column_stack([scene.field.frame.to_world_array(places), np.ones(r.size)]) @ matrix.T
        assert not (np.abs(clip[:, :3]) <= clip[:, 3:]).all(axis=1).any()
        culled += 1
    assert culled == selection.stats.culled_blocks


def test_culling_leaves_out_blocks_behind_the_eye(scene: Scene) -> None:
    selection = scene.selector.select(CAMERAS[2], scene.field.frame, SIZE, 2.0)

    assert selection.stats.culled_blocks > 0.4 * scene.tiling.block_count
    everything = scene.selector.select(CAMERAS[2], scene.field.frame, SIZE, 2.0, cull=False)
    assert everything.stats.culled_blocks == 0
    assert everything.stats.terrain_triangles > selection.stats.terrain_triangles


@pytest.mark.parametrize("camera", CAMERAS)
def test_each_edge_is_fitted_to_the_coarser_of_both_sides(scene: Scene, camera: Camera) -> None:
    selection = scene.selector.select(camera, scene.field.frame, SIZE, 2.0, cull=False)
    grid = selection.level.reshape(scene.tiling.block_rows, scene.tiling.block_cols)
    for level, instances in enumerate(selection.terrain):
        for instance in instances:
            row, col = int(instance["row"]), int(instance["col"])
            assert grid[row, col] == level
            for edge, (dr, dc) in {"w": (0, -1), "e": (0, 1), "s": (-1, 0), "n": (1, 0)}.items():
                r, c = row + dr, col + dc
                inside = 0 <= r < grid.shape[0] and 0 <= c < grid.shape[1]
                assert instance[edge] == max(level, grid[r, c] if inside else 0)


def test_a_finer_threshold_draws_more_triangles(scene: Scene) -> None:
    counts = [
        scene.selector.select(CAMERAS[0], scene.field.frame, SIZE, tau).stats.terrain_triangles
        for tau in (0.5, 1.0, 2.0, 4.0, 8.0)
    ]

    assert counts == sorted(counts, reverse=True)
    assert counts[0] > 4 * counts[-1]


def test_the_full_mesh_is_every_triangle(scene: Scene) -> None:
    nrows, ncols = scene.field.z_b.shape
    selection = scene.selector.select(CAMERAS[0], scene.field.frame, SIZE, 2.0, full_mesh=True, cull=False)

    assert selection.stats.terrain_triangles == 2 * (nrows - 1) * (ncols - 1)


def test_water_states_decide_what_is_drawn(scene: Scene) -> None:
    states = np.zeros(scene.tiling.block_count, dtype=np.uint8)
    states[10], states[11], states[30] = 1, 2, 2
    selection = scene.selector.select(
        CAMERAS[0], scene.field.frame, SIZE, 4.0, states=states, depth_max=3.0, cull=False
    )
    cols = scene.tiling.block_cols
    terrain = {int(i["row"]) * cols + int(i["col"]) for level in selection.terrain for i in level}
    water = {int(i["row"]) * cols + int(i["col"]) for level in selection.water for i in level}

    assert water == {10, 11, 30}
    assert terrain == set(range(scene.tiling.block_count)) - {11, 30}
    assert selection.level[10] == 0
    assert (selection.stats.covered_blocks, selection.stats.water_blocks) == (2, 3)


def test_covered_terrain_is_drawn_on_request(scene: Scene) -> None:
    states = np.full(scene.tiling.block_count, 2, dtype=np.uint8)
    selection = scene.selector.select(
        CAMERAS[0], scene.field.frame, SIZE, 4.0, states=states, cull=False, cull_covered_terrain=False
    )

    assert selection.stats.terrain_blocks == scene.tiling.block_count


def test_pinned_blocks_are_at_full_resolution(scene: Scene) -> None:
    pinned = np.zeros(scene.tiling.block_count, dtype=bool)
    pinned[[5, 6]] = True
    free = scene.selector.select(CAMERAS[0], scene.field.frame, SIZE, 8.0)
    held = scene.selector.select(CAMERAS[0], scene.field.frame, SIZE, 8.0, pinned=pinned)

    assert (free.level[pinned] > 0).all()
    assert (held.level[pinned] == 0).all()
    assert np.array_equal(free.level[~pinned], held.level[~pinned])


def test_wet_blocks_are_spaced_as_the_screen_asks(scene: Scene) -> None:
    states = np.full(scene.tiling.block_count, 2, dtype=np.uint8)
    camera = CAMERAS[0]
    full = scene.selector.select(camera, scene.field.frame, SIZE, 2.0, states=states)
    spaced = scene.selector.select(camera, scene.field.frame, SIZE, 2.0, states=states, water_spacing_px=6.0)
    scale = pixels_per_slope(SIZE[1], camera.fov_y)

    assert (full.level == 0).all()
    assert spaced.level.max() > 0
    for (low, high), level in zip(scene.boxes(), spaced.level, strict=True):
        distance = np.linalg.norm(np.clip(camera.eye, low, high) - camera.eye)
        if level:
            assert (1 << int(level)) * scene.field.grid.dx * scale / distance <= 6.0 * 1.001


def test_exaggeration_asks_for_finer_levels(scene: Scene) -> None:
    frame = scene.field.frame
    plain = scene.selector.select(CAMERAS[0], frame, SIZE, 4.0)
    tall = scene.selector.select(CAMERAS[0], frame.exaggerated(4.0), SIZE, 4.0)

    assert tall.stats.terrain_triangles > plain.stats.terrain_triangles


@pytest.mark.parametrize("block_size", [17, 33, 65])
def test_the_triangle_count_is_that_of_the_triangles_with_an_area(
    make_heightfield: Callable[..., Heightfield], block_size: int
) -> None:
    scene = Scene(make_heightfield(150, 111), block_size)
    selection = scene.selector.select(CAMERAS[1], scene.field.frame, SIZE, 3.0, cull=False)
    tiling, stride = scene.tiling, scene.tiling.stride
    count = 0
    for level, instances in enumerate(selection.terrain):
        step = 1 << level
        for instance in instances:

            def vertex(i: int, j: int, at: np.void = instance) -> tuple[int, int]:
                x, y = i, j
                if i == 0:
                    y = (j >> int(at["w"])) << int(at["w"])
                if i == stride:
                    y = (j >> int(at["e"])) << int(at["e"])
                if j == 0:
                    x = (i >> int(at["s"])) << int(at["s"])
                if j == stride:
                    x = (i >> int(at["n"])) << int(at["n"])
                col, row = int(at["col"]) * stride + x, int(at["row"]) * stride + y
                return min(col, tiling.ncols - 1), min(row, tiling.nrows - 1)

            for j in range(0, stride, step):
                for i in range(0, stride, step):
                    a, b = vertex(i, j), vertex(i + step, j)
                    c, d = vertex(i + step, j + step), vertex(i, j + step)
                    for p, q, r in ((a, b, c), (a, c, d)):
                        count += (q[0] - p[0]) * (r[1] - p[1]) != (r[0] - p[0]) * (q[1] - p[1])
    assert selection.stats.terrain_triangles == count


def test_without_classification_all_water_is_drawn_and_the_ground_knows_of_none(scene: Scene) -> None:
    states = np.zeros(scene.tiling.block_count, np.uint8)
    states[:3] = (1, 2, 2)

    def select(**options: object) -> Selection:
        return scene.selector.select(CAMERAS[0], scene.field.frame, SIZE, 4.0, cull=False, **options)  # type: ignore[arg-type]

    unclassified, dry = select(states=states, classify_water=False), select()
    full = select(full_mesh=True)

    assert unclassified.stats.water_blocks == scene.tiling.block_count
    assert unclassified.stats.water_triangles == full.stats.terrain_triangles
    assert [len(blocks) for blocks in unclassified.water] == [scene.tiling.block_count] + [0] * (
        scene.tiling.level_count - 1
    )
    for ours, theirs in zip(unclassified.terrain, dry.terrain, strict=True):
        assert np.array_equal(ours, theirs)
    assert select(states=states).stats.water_blocks == 3
