"""The process that computes: one thread owns Warp; it ends by Quit or by the end of its pipe."""

from __future__ import annotations

import gc
import logging
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable
from multiprocessing.connection import Connection

from solver_service.errors import ServiceError
from solver_service.logging_setup import set_up_logging
from solver_service.runs.inbox import Inbox
from solver_service.runs.native_lines import give_stderr_to
from solver_service.runs.worker_failure import failure_of
from solver_service.runs.worker_messages import Failed, Pulse, Ready, Report, Unfit, WorkerSettings

LOG = logging.getLogger(__name__)

FAILED = 1
PULSE_INTERVAL_S = 1.0


def worker_main(settings: WorkerSettings, connection: Connection, errors: Connection) -> None:
    """Body of the process.

    Args:
        settings: what the worker is told.
        connection: its end of the pipe.
        errors: the pipe for what libraries write to standard error.
    """
    loops: list[RunLoop] = []  # none while it starts
    set_up_logging(
        settings.log_format,
        settings.log_level,
        lambda: {"run": loops[0].run} if loops else {},
        give_stderr_to(errors),
    )
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the service, which then tells its workers
    send_lock = threading.Lock()

    def report(message: Report) -> None:
        with send_lock:
            try:
                connection.send(message)
            except OSError:
                LOG.info("the service is gone; nobody hears %s", type(message).__name__)

    inbox = Inbox(connection)
    threading.Thread(target=_beat, args=(inbox, report), name="worker-pulse", daemon=True).start()

    # the heavy imports are what a warm worker has behind it
    from solver_service.numerics import device_names, warm_kernels
    from solver_service.runs.run_loop import RunLoop

    try:
        warm_kernels(settings.device)
    except ServiceError as error:
        report(Unfit(str(error)))
        return
    gc.freeze()
    gc.disable()  # a collection on another thread can break a CUDA graph capture; the solver thread collects
    loop = RunLoop(settings, inbox, report)
    loops.append(loop)

    def give_up(error: BaseException | None) -> None:
        """Say why, and end: after an error that nobody foresaw neither memory nor device can be trusted."""
        try:
            LOG.error("the worker gives up", exc_info=error)
            kind, message = failure_of(error or RuntimeError("a thread ended"))
            report(Failed(loop.run, kind, message, ending=True))
        finally:
            os._exit(FAILED)

    threading.excepthook = lambda thread: give_up(thread.exc_value)
    LOG.info("worker process %d is ready", os.getpid())
    report(Ready(os.getpid(), tuple(device_names())))
    try:
        loop.serve()
    except Exception as error:
        give_up(error)


def _beat(inbox: Inbox, report: Callable[[Report], None]) -> None:
    """Tell each second that the process lives, and whether its solver thread goes on."""
    while True:
        report(Pulse(inbox.looks, inbox.is_waited_for))
        time.sleep(PULSE_INTERVAL_S)


def start_worker(
    settings: WorkerSettings,
) -> tuple[multiprocessing.process.BaseProcess, Connection, Connection]:
    """Start a worker.

    Returns:
        The process, this side's end of the pipe, and the end of the pipe for its errors.
    """
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    errors, their_errors = context.Pipe(duplex=False)
    arguments = (settings, theirs, their_errors)
    process = context.Process(target=worker_main, args=arguments, name="fev-worker", daemon=True)
    process.start()
    theirs.close()
    their_errors.close()
    return process, ours, errors
