"""The test tree mirrors the packages: who changes a module knows where its tests are."""

from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
PACKAGES = ("protocol", "solver_service", "viewer")

# Modules without a test module of their own, and where they are tested instead. This list may only shrink.
TESTED_ELSEWHERE = {
    "solver_service/numerics/channel_kernels.py": "tests/solver_service/numerics/test_read_out.py",
    "solver_service/numerics/clock_kernels.py": "tests/solver_service/numerics/test_engines.py",
    "solver_service/numerics/edge_kernels.py": "tests/solver_service/numerics/test_edges.py",
    "solver_service/numerics/engine.py": "tests/solver_service/numerics/test_engines.py",
    "solver_service/numerics/fields.py": "tests/solver_service/numerics/test_solver.py",
    "solver_service/numerics/forcing_kernels.py": "tests/solver_service/numerics/test_forcing.py",
    "solver_service/numerics/gauge_kernels.py": "tests/solver_service/numerics/test_gauges.py",
    "solver_service/numerics/ghost_kernels.py": "tests/solver_service/numerics/test_engines.py",
    "solver_service/numerics/infiltration_kernels.py": "tests/solver_service/numerics/test_infiltration.py",
    "solver_service/numerics/reconstruction.py": "tests/solver_service/numerics/test_engines.py",
    "solver_service/numerics/row_engine.py": "tests/solver_service/numerics/test_engines.py",
    "solver_service/numerics/row_kernels.py": "tests/solver_service/numerics/test_engines.py",
    "solver_service/numerics/section_kernels.py": "tests/solver_service/numerics/test_section_recorder.py",
    "solver_service/numerics/snapshot.py": "tests/solver_service/numerics/test_solver.py",
    "solver_service/numerics/step_kernels.py": "tests/solver_service/numerics/test_engines.py",
    "solver_service/numerics/tile_kernels.py": "tests/solver_service/numerics/test_active_tiles.py",
    "solver_service/numerics/warp_modules.py": "tests/solver_service/numerics/test_device.py",
    "solver_service/runs/case_catalogue.py": "tests/solver_service/runs/test_registry.py",
    "solver_service/runs/computation.py": "tests/end_to_end/test_stream_and_recalculate.py",
    "solver_service/runs/run_loop.py": "tests/end_to_end/test_stream_and_recalculate.py",
    "solver_service/runs/run_tree.py": "tests/solver_service/runs/test_registry.py",
    "solver_service/runs/state_keeper.py": "tests/end_to_end/test_service_life.py",
    "solver_service/runs/store_thread.py": "tests/end_to_end/test_service_life.py",
    "solver_service/runs/worker.py": "tests/end_to_end/test_stream_and_recalculate.py",
    "solver_service/runs/worker_messages.py": "tests/end_to_end/test_stream_and_recalculate.py",
    "solver_service/runs/worker_process.py": "tests/end_to_end/test_stream_and_recalculate.py",
    "solver_service/store/records.py": "tests/solver_service/store/test_run_database.py",
    "solver_service/web/frame_feed.py": "tests/end_to_end/test_flow.py",
    "solver_service/web/server.py": "tests/end_to_end/test_service_life.py",
    "solver_service/web/settings.py": "tests/solver_service/web/test_app.py",
}


def modules() -> list[str]:
    """Every module with code of its own, as a path like `protocol/grid.py`."""
    paths = [path for package in PACKAGES for path in sorted((REPOSITORY / package).rglob("*.py"))]
    return [
        path.relative_to(REPOSITORY).as_posix()
        for path in paths
        if path.name not in ("__init__.py", "__main__.py")
    ]


def test_module_of(module: str) -> Path:
    path = REPOSITORY / "tests" / module
    return path.with_name(f"test_{path.name}")


test_module_of.__test__ = False  # type: ignore[attr-defined]  # a helper, not a test


def test_every_module_has_its_test_module() -> None:
    lonely = [
        name for name in modules() if not test_module_of(name).is_file() and name not in TESTED_ELSEWHERE
    ]

    assert not lonely, "\n".join(lonely)


def test_the_list_of_exceptions_only_shrinks() -> None:
    known = set(modules())
    needless = [name for name in TESTED_ELSEWHERE if name not in known or test_module_of(name).is_file()]
    wrong = [place for place in TESTED_ELSEWHERE.values() if not (REPOSITORY / place).exists()]

    assert not needless
    assert not wrong
