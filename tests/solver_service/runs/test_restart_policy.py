from solver_service.runs.restart_policy import RestartPolicy
from solver_service.runs.worker_failure import FailureKind


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


def test_a_run_is_restarted_so_often_within_the_time_and_no_more() -> None:
    clock = Clock()
    policy = RestartPolicy(2, 100.0, clock)
    assert [policy.grant("r1", FailureKind.KILLED) for _ in range(3)] == [1, 2, 0]
    assert policy.grant("r2", FailureKind.KILLED) == 1
    clock.now = 101.0
    assert policy.grant("r1", FailureKind.KILLED) == 1


def test_a_blow_up_is_never_retried() -> None:
    policy = RestartPolicy(5)
    assert policy.grant("r1", FailureKind.BLOW_UP) == 0
    assert policy.grant("r1", FailureKind.REFUSED) == 0
    assert policy.grant("r1", FailureKind.OUT_OF_MEMORY) == 1


def test_no_attempts_means_no_restart() -> None:
    assert RestartPolicy(0).grant("r1", FailureKind.KILLED) == 0


def test_a_person_who_takes_the_run_up_clears_its_past() -> None:
    policy = RestartPolicy(1)
    assert policy.grant("r1", FailureKind.KILLED) == 1
    assert policy.grant("r1", FailureKind.KILLED) == 0
    policy.forget("r1")
    assert policy.grant("r1", FailureKind.KILLED) == 1
