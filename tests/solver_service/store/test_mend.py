from pathlib import Path

from solver_service.store import DataFolder, FrameWriter, RunDatabase, RunRecord, mend_run, remove_run_files

RUN = RunRecord("r1", "case", "f00d", "Title", None, 0, "running", "", 100.0, 5.0, "auto", 0, b"[]", b"{}")


def test_mending_cuts_torn_tails_and_removes_what_has_no_row(tmp_path: Path) -> None:
    folder = DataFolder(tmp_path)
    database = RunDatabase(folder.database)
    database.begin_epoch()
    database.insert_run(RUN)
    writer = FrameWriter(folder, database, "r1")
    row = writer.append(index=0, time=0.0, revision=0, key_index=0, frame=b"whole")
    writer.close()
    segment = folder.frames("r1") / row.segment
    segment.write_bytes(b"wholetorn")
    (folder.frames("r1") / "000002.segment").write_bytes(b"no row")
    (folder.checkpoints("r1") / "step3-0000").mkdir(parents=True)
    mend_run(folder, database, "r1")
    assert segment.read_bytes() == b"whole"
    assert list(folder.frames("r1").iterdir()) == [segment]
    assert not list(folder.checkpoints("r1").iterdir())
    mend_run(folder, database, "r1")
    assert segment.read_bytes() == b"whole"
    database.delete_run("r1")
    remove_run_files(folder, "r1")
    assert not folder.frames("r1").exists()
    assert not folder.checkpoints("r1").exists()
    remove_run_files(folder, "r1")
    database.close()
