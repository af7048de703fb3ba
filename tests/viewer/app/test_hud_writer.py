from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import INTERVAL
from viewer.app.hud_writer import PERIOD_S, HudWriter
from viewer.app.measuring import Measuring
from viewer.commands import Pause, Seek
from viewer.render import RenderOptions

OPTIONS = RenderOptions()


def writer(flight: Flight) -> HudWriter:
    return HudWriter(flight.app.control, flight.app.clock, Measuring())


def test_the_text_tells_run_and_time(flight: Flight) -> None:
    flight.do(Pause(), Seek(6.0 * INTERVAL))
    text = writer(flight).write(flight.shown, OPTIONS)

    assert (text.title, text.time, text.notice) == ("Tiny valley", "00:01:00", "")
    assert text.is_hypothetical
    assert "running, computed until 00:03:10 on cpu" in text.detail


def test_text_is_old_once_it_says_something_else_but_is_not_looked_at_often(flight: Flight) -> None:
    hud = writer(flight)
    flight.do(Pause(), Seek(6.0 * INTERVAL))
    hud.write(flight.shown, OPTIONS)
    assert not hud.is_old(flight.shown, OPTIONS, 100.0)
    flight.do(Seek(7.0 * INTERVAL))
    assert not hud.is_old(flight.shown, OPTIONS, 100.0 + 0.5 * PERIOD_S)
    assert hud.is_old(flight.shown, OPTIONS, 100.0 + 1.5 * PERIOD_S)
    hud.write(flight.shown, OPTIONS)

    assert not hud.is_old(flight.shown, OPTIONS, 100.0 + 3.0 * PERIOD_S)


def test_a_lost_service_is_told_on_the_picture(flight: Flight) -> None:
    flight.service.close()
    flight.until(lambda: not flight.app.desk.is_open)

    assert "This picture is" in writer(flight).write(flight.shown, OPTIONS).notice
