from solver_service.store import CheckpointRecord, StoredRun, plan_removals


def checkpoints(run: str, count: int, size: int = 10) -> tuple[CheckpointRecord, ...]:
    return tuple(CheckpointRecord(run, float(k), k, f"step{k}", 0, size) for k in range(count))


def stored(run: str, parent: str | None = None, ended: bool = True, pinned: bool = False) -> StoredRun:
    return StoredRun(run, parent, ended, pinned, 100, checkpoints(run, 4))


def names(plan: list) -> list[str]:
    return [f"{r.run}:{r.checkpoint.name if r.checkpoint else 'all'}" for r in plan]


def test_middle_checkpoints_go_first_then_the_others_then_whole_runs_oldest_first() -> None:
    plan = plan_removals([stored("a"), stored("b")], 10_000)
    assert names(plan) == [
        "a:step1",
        "a:step2",
        "b:step1",
        "b:step2",
        "a:step0",
        "a:step3",
        "b:step0",
        "b:step3",
        "a:all",
        "b:all",
    ]
    assert sum(removal.size for removal in plan) == 2 * (100 + 40)


def test_no_more_goes_than_is_needed() -> None:
    assert names(plan_removals([stored("a"), stored("b")], 15)) == ["a:step1", "a:step2"]
    assert plan_removals([stored("a")], 0) == []


def test_nothing_goes_of_a_run_that_is_pinned_or_has_not_ended() -> None:
    assert plan_removals([stored("a", pinned=True), stored("b", ended=False)], 10_000) == []


def test_an_ancestor_stays_as_long_as_a_descendant_needs_its_past() -> None:
    runs = [stored("root"), stored("child", "root"), stored("live", "child", ended=False)]
    assert "root:all" not in names(plan_removals(runs, 10_000))
    assert "child:all" not in names(plan_removals(runs, 10_000))
    runs = [stored("root"), stored("child", "root"), stored("kept", "root", pinned=True)]
    whole = [name for name in names(plan_removals(runs, 10_000)) if name.endswith("all")]
    assert whole == ["child:all"]
    runs = [stored("root"), stored("child", "root"), stored("leaf", "child")]
    whole = [name for name in names(plan_removals(runs, 10_000)) if name.endswith("all")]
    assert whole == ["leaf:all", "child:all", "root:all"]


def test_a_run_with_one_checkpoint_loses_it_once() -> None:
    run = StoredRun("a", None, True, False, 100, checkpoints("a", 1))
    assert names(plan_removals([run], 10_000)) == ["a:step0", "a:all"]
