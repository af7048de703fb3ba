"""What goes with the depth of a frame: dry cells carry nothing, and what was ever reached stays."""

import numpy as np

from protocol import BlockLayout, decode_channel, unpack_channel
from solver_service.numerics.fields import NEVER
from solver_service.runs.quantised_frame import QuantisedFrame, pack_channels

LAYOUT = BlockLayout(40, 100)


def frame(channels: dict[str, dict[str, np.ndarray]]) -> QuantisedFrame:
    q = np.zeros((40, 100), np.uint16)
    q[3:9, 2:6] = 70
    return QuantisedFrame("r", 4, 20.0, 0, q, LAYOUT.classify(q), 0.001, channels=channels, depth_wet=0.01)


def test_a_frame_without_channels_packs_none() -> None:
    assert pack_channels(frame({}), LAYOUT) == {}


def test_a_dry_cell_has_no_velocity_whatever_the_solver_left_there() -> None:
    u = np.full((40, 100), 2.0, np.float32)
    velocity = frame({"velocity": {"u": u, "v": -u}})
    decoded = decode_channel(LAYOUT, unpack_channel(pack_channels(velocity, LAYOUT)["velocity"]))
    wet = velocity.q > 0
    np.testing.assert_allclose(decoded.fields["u"], np.where(wet, 2.0, 0.0), atol=1e-3)
    np.testing.assert_allclose(decoded.fields["v"], np.where(wet, -2.0, 0.0), atol=1e-3)


def test_maxima_reach_as_far_as_water_ever_did_and_a_film_does_not_count() -> None:
    shape = (40, 100)
    depth, arrival = np.full(shape, 0.009, np.float32), np.full(shape, NEVER, np.float32)
    depth[:, 50:70], arrival[:, 50:60] = 1.5, 12.0  # deep water that is gone now
    speed = np.full(shape, 3.0, np.float32)
    maxima = frame(
        {
            "maxima": {
                "max_depth": depth,
                "max_speed": speed,
                "max_hazard": speed.copy(),
                "arrival_time": arrival,
            }
        }
    )
    packed = unpack_channel(pack_channels(maxima, LAYOUT)["maxima"])
    fields = decode_channel(LAYOUT, packed).fields
    reached = np.zeros(shape, bool)
    reached[:, 50:70] = True
    for name, value in (("max_depth", 1.5), ("max_speed", 3.0), ("max_hazard", 3.0)):
        np.testing.assert_allclose(fields[name], np.where(reached, value, 0.0), atol=1e-3)
    np.testing.assert_array_equal(np.isfinite(fields["arrival_time"]), reached & (np.arange(100) < 60))
    assert packed.raw_size < 8 * 40 * 100, "blocks that water never reached are left out"
