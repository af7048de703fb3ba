from tests.viewer.app.conftest import Flight
from viewer.commands import SetOption


def test_colours_reach_picture_and_status(flight: Flight) -> None:
    flight.do(SetOption("water_colour", "depth"))
    flight.until(lambda: flight.app.water.look.colouring is not None)
    inputs = flight.app.frame_inputs()
    status = flight.app.fresh_status()

    assert inputs is not None
    assert inputs.colouring is not None
    assert status.water_colour == "depth"
    assert [row.text for row in status.legend] == list(inputs.colouring.scale.labels)

    flight.do(SetOption("water_colour", "natural"))
    flight.until(lambda: flight.app.water.look.colouring is None)
    inputs = flight.app.frame_inputs()
    assert inputs is not None
    assert inputs.colouring is None
    assert flight.app.fresh_status().legend == ()
