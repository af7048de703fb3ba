import math

import numpy as np
import pytest

from protocol import GridGeometry
from tests.viewer.conftest import hills
from viewer.lod import (
    BlockQuadtree,
    BlockSelector,
    BlockTiling,
    Border,
    Selection,
    SwitchTable,
    block_bounds,
    block_errors,
    edge_errors,
    pixels_per_slope,
    screen_error_factor,
)
from viewer.world import Camera, Heightfield, overview

SIZE = (640, 400)


class Scene:
    def __init__(
        self, field: Heightfield, block_size: int = 33, border: Border = Border.RAGGED, charged: bool = False
    ) -> None:
        self.field = field
        self.tiling = BlockTiling(field.grid.nrows, field.grid.ncols, block_size, border)
        self.errors = block_errors(field.z_b, self.tiling)
        self.bounds = block_bounds(field.z_b, self.tiling)
        charges = edge_errors(field.z_b, self.tiling, self.errors) if charged else None
        table = SwitchTable(self.errors, charges)
        self.selector = BlockSelector(self.tiling, field.grid.dx, table, self.bounds)

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


# --- the quadtree ------------------------------------------------------------------------------------


def assert_equal_pictures(first: Selection, second: Selection) -> None:
    assert first.stats == second.stats
    assert (first.distance_min, first.distance_max) == (second.distance_min, second.distance_max)
    assert np.array_equal(first.visible, second.visible)
    assert np.array_equal(first.level[first.visible], second.level[first.visible])
    for ours, theirs in zip(first.terrain + first.water, second.terrain + second.water, strict=True):
        assert np.array_equal(ours, theirs)


@pytest.mark.parametrize("seed", range(8))
def test_the_quadtree_selects_what_looking_at_every_block_selects(seed: int) -> None:
    rng = np.random.default_rng(seed)
    nrows, ncols = (int(n) for n in rng.integers(40, 420, 2))
    grid = GridGeometry(nrows=nrows, ncols=ncols, dx=10.0, x0=0.0, y0=0.0)
    field = Heightfield(grid, hills(nrows, ncols, 10.0, float(rng.uniform(5.0, 300.0)), seed))
    border = list(Border)[seed % 3]
    scene = Scene(field, (17, 17, 33, 65)[seed % 4], border, charged=True)
    count = scene.tiling.block_count
    culled = 0
    for _ in range(25):
        x, z = rng.uniform(-0.6, 0.6, 2) * (ncols * 10.0, nrows * 10.0)
        camera = Camera(
            (x, float(rng.uniform(-50.0, 200.0)), z),
            float(10.0 ** rng.uniform(1.5, 3.5)),
            float(rng.uniform(-3.0, 3.0)),
            float(rng.uniform(0.02, 1.5)),
        )
        options: dict[str, object] = {
            "states": rng.integers(0, 3, count).astype(np.uint8) if rng.random() < 0.7 else None,
            "depth_max": 40.0,
            "water_spacing_px": float(rng.choice([0.0, 3.0])),
            "cull_covered_terrain": bool(rng.random() < 0.7),
            "classify_water": bool(rng.random() < 0.8),
            "full_mesh": bool(rng.random() < 0.1),
        }
        frame = field.frame.exaggerated(float(rng.choice([1.0, 3.0])))
        tau = float(rng.choice([0.5, 2.0, 8.0]))
        flat = scene.selector.select(camera, frame, SIZE, tau, quadtree=False, **options)  # type: ignore[arg-type]
        tree = scene.selector.select(camera, frame, SIZE, tau, quadtree=True, **options)  # type: ignore[arg-type]
        assert_equal_pictures(flat, tree)
        culled += flat.stats.culled_blocks
    assert culled > 0


def test_a_tree_that_loses_a_block_in_view_is_caught(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = BlockQuadtree.candidates
    monkeypatch.setattr(BlockQuadtree, "candidates", lambda *args: np.sort(whole(*args))[40:])
    flat, tree = (
        scene.selector.select(CAMERAS[1], scene.field.frame, SIZE, 2.0, quadtree=way) for way in (False, True)
    )
    with pytest.raises(AssertionError):
        assert_equal_pictures(flat, tree)


def test_the_quadtree_sees_ground_that_an_edit_raised(scene: Scene) -> None:
    frame = scene.field.frame
    level = Camera((0.0, 3000.0, 0.0), 1500.0, 0.0, 0.0)
    before = scene.selector.select(level, frame, SIZE, 2.0, quadtree=True)
    scene.bounds.z_max[0, :] = 3000.0
    scene.selector.refresh()
    after = scene.selector.select(level, frame, SIZE, 2.0, quadtree=True)

    assert before.stats.terrain_blocks < after.stats.terrain_blocks
    assert_equal_pictures(after, scene.selector.select(level, frame, SIZE, 2.0, quadtree=False))


def test_without_culling_the_quadtree_leaves_nothing_out(scene: Scene) -> None:
    selection = scene.selector.select(CAMERAS[1], scene.field.frame, SIZE, 2.0, cull=False, quadtree=True)
    assert selection.stats.terrain_blocks == scene.tiling.block_count
