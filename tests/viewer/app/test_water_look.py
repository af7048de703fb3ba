from tests.viewer.app.conftest import Flight
from viewer.app.water_look import WaterLook
from viewer.world import WaterColour


def test_depth_needs_no_channel_and_natural_water_no_classes(flight: Flight) -> None:
    look = WaterLook()

    assert not look.follow(flight.shown, WaterColour.NATURAL)
    assert look.colouring is None
    assert look.follow(flight.shown, WaterColour.DEPTH)
    assert look.colouring is not None
    assert look.legend()[0].text == "< 0.15"
    assert look.legend()[0].colour == look.colouring.scale.colours[0]
    assert not look.follow(flight.shown, WaterColour.DEPTH)
