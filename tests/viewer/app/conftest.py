"""A viewer's state machine on a tiny service, without any picture."""

import time
from collections.abc import Callable, Iterator

import moderngl
import pytest

from tests.viewer.tiny_service import TOKEN, TinyService
from viewer.app.shown_run import ShownRun
from viewer.app.viewer_app import ViewerApp
from viewer.commands import Command, StartRun
from viewer.net import BackOff, ConnectionThread, FrameLoader
from viewer.render import create_headless_context


class Flight:
    """A connected viewer that has started the tiny run."""

    def __init__(self, service: TinyService, start: bool = True) -> None:
        self.service = service
        connection = ConnectionThread(service.url, TOKEN, back_off=BackOff(first_s=0.05, longest_s=0.1))
        self.app = ViewerApp(connection, FrameLoader(), StartRun("tiny") if start else None)
        connection.start()

    @property
    def shown(self) -> ShownRun:
        assert self.app.shown is not None
        return self.app.shown

    def until(
        self, condition: Callable[[], bool], timeout_s: float = 10.0, size: tuple[int, int] = (64, 36)
    ) -> None:
        """Let the viewer go on, with a picture now and then, until a condition holds."""
        end = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end, f"waited in vain; the viewer says {self.app.message!r}"
            if self.app.advance(time.monotonic()) and self.app.frame_inputs() is not None:
                self.app.note_painted(size)
            time.sleep(0.002)

    def do(self, *commands: Command) -> None:
        for command in commands:
            self.app.carry_out(command)

    def have_frames(self, count: int) -> None:
        self.until(lambda: self.app.shown is not None and len(self.app.shown.timeline) >= count)

    def settle(self) -> None:
        self.until(lambda: self.app.is_settled)

    def close(self) -> None:
        self.app.close()
        self.service.close()


@pytest.fixture(scope="module")
def ctx() -> Iterator[moderngl.Context]:
    """A context of this module's own: the one of the render tests must stay current for them."""
    context = create_headless_context()
    yield context
    context.release()


@pytest.fixture
def flight() -> Iterator[Flight]:
    made = Flight(TinyService(computed=20))
    made.have_frames(20)
    yield made
    made.close()
