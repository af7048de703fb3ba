from pathlib import Path

import netCDF4
import numpy as np
import pytest
import zarr

from protocol import EditLine, EditType, FrameEncoder, GridGeometry, GridInfo, Operation, apply_edits
from solver_service.runs.case_facts import CaseFacts
from solver_service.runs.edit_blobs import pack_edits
from solver_service.store import DataFolder, FrameWriter, RunDatabase, RunRecord, save_bed

GRID = GridGeometry(nrows=40, ncols=50, dx=10.0, x0=0.0, y0=0.0, crs="local", datum_offset=100.0)
BED = np.linspace(0.0, 5.0, 2000, dtype=np.float32).reshape(GRID.shape)
LEVEE = EditLine(
    id="levee",
    vertices=((100.0, 100.0), (100.0, 300.0)),
    width=20.0,
    operation=Operation.raise_,
    type=EditType.modulate,
    magnitude=4.0,
)
SCALE = 0.001
BREACHED = np.array([7 * 50 + 8, 8 * 50 + 8], np.int64), np.array([-0.5, -0.25], np.float32)
"""What a breach has lowered from frame 3 on."""


def depth(run: str, index: int) -> np.ndarray:
    """A pool that deepens with time, twice as deep in the branch."""
    h = np.zeros(GRID.shape, np.float32)
    h[5:30, 5 : 10 + index] = 0.25 * (index + 1) * (2.0 if run == "child" else 1.0)
    return h


@pytest.fixture
def store(tmp_path: Path) -> Path:
    """A parent with frames 0 to 4 and a child that branched from it at frame 2."""
    folder = DataFolder(tmp_path / "data")
    database = RunDatabase(folder.database)
    database.begin_epoch()
    save_bed(folder, "f00d", BED)
    facts = CaseFacts(GridInfo.from_geometry(GRID), True, 0.001, "made up", "public domain").pack()
    for run, parent, branch, edits, last in (("parent", None, 0, (), 4), ("child", "parent", 2, (LEVEE,), 5)):
        database.insert_run(
            RunRecord(
                run,
                "tiny",
                "f00d",
                "A dam",
                parent,
                branch,
                "finished",
                "",
                25.0,
                5.0,
                "cpu",
                0,
                pack_edits(edits),
                facts,
            )
        )
        writer, encoder = FrameWriter(folder, database, run), FrameEncoder(GRID, depth_wet=0.001)
        for index in range(branch, last + 1):
            bed = BREACHED if index >= 3 else None
            frame = encoder.encode(run, index, 5.0 * index, 0, depth(run, index), scale=SCALE, bed=bed)
            key = branch
            writer.append(index=index, time=5.0 * index, revision=0, key_index=key, frame=frame)
        writer.close()
    database.insert_run(
        RunRecord(
            "empty",
            "tiny",
            "f00d",
            "A dam",
            None,
            0,
            "starting",
            "",
            25.0,
            5.0,
            "cpu",
            0,
            pack_edits(()),
            facts,
        )
    )
    database.close()
    return tmp_path / "data"


def test_a_branch_is_exported_with_the_past_of_its_parent(store: Path, tmp_path: Path, fev_solver) -> None:
    answer = fev_solver("export", "child", "--out", tmp_path / "out", "--data-dir", store)

    assert answer.code == 0
    assert "6 frames of run child" in answer.out
    with netCDF4.Dataset(tmp_path / "out" / "timesteps.nc") as file:
        assert file["time"][:].tolist() == [0.0, 5.0, 10.0, 15.0, 20.0, 25.0]
        for index in range(6):
            expected = depth("parent" if index < 2 else "child", index)
            np.testing.assert_allclose(file["depth"][index], expected, atol=SCALE)
        raised = apply_edits(BED, [LEVEE], GRID).z_b
        np.testing.assert_array_equal(file["bed"][:], raised + np.float32(100.0))
        for index in range(6):
            bed = (BED if index < 2 else raised).copy()
            if index >= 3:
                bed.flat[BREACHED[0]] = BREACHED[1]
            h, level = file["depth"][index].filled(), file["level"][index].filled(np.nan)
            np.testing.assert_array_equal(level[h > 0], (bed + h + np.float32(100.0))[h > 0])
            assert np.isnan(level[h == 0]).all()


def test_a_root_is_exported_as_zarr(store: Path, tmp_path: Path, fev_solver) -> None:
    assert fev_solver("export", "parent", "--out", tmp_path / "out", "--data-dir", store, "--zarr").code == 0

    group = zarr.open_group(str(tmp_path / "out" / "timesteps.zarr"), mode="r")
    np.testing.assert_allclose(group["depth"][:], [depth("parent", index) for index in range(5)], atol=SCALE)
    assert group.attrs["hypothetical"] is True


@pytest.mark.parametrize(
    ("run", "message"),
    [
        ("atlantis", "no run 'atlantis'; child, empty, parent is stored"),
        ("empty", "'empty' has no frame yet"),
    ],
)
def test_a_run_that_is_not_there_is_told(
    store: Path, tmp_path: Path, fev_solver, run: str, message: str
) -> None:
    answer = fev_solver("export", run, "--out", tmp_path / "out", "--data-dir", store)

    assert answer.code == 2
    assert message in answer.err
    assert not (tmp_path / "out").exists()


def test_a_damaged_frame_leaves_no_output(store: Path, tmp_path: Path, fev_solver) -> None:
    segment = next(path for path in (store / "frames" / "parent").iterdir())
    data = bytearray(segment.read_bytes())
    data[len(data) // 2] ^= 0xFF
    segment.write_bytes(data)

    answer = fev_solver("export", "parent", "--out", tmp_path / "out", "--data-dir", store)

    assert answer.code == 2
    assert "damaged" in answer.err
    assert not (tmp_path / "out").exists()
