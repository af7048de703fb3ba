"""Classes of water: limits, labels, hazard rating, and colours that stay apart for every kind of sight."""

import numpy as np
import pytest

from viewer.units import METRIC, US
from viewer.world import ClassScale, WaterColour, arrival_scale, hazard_rating, water_scale
from viewer.world.water_scales import LEAST_COLOUR_DISTANCE

# Machado, Oliveira and Fernandes (2009), severity 1, on linear sRGB.
SIGHTS = {
    "normal": np.eye(3),
    "protanopia": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}
SCALES = [water_scale(colour, 3600.0) for colour in WaterColour if colour is not WaterColour.NATURAL]


def cielab(colours: object, sight: object = SIGHTS["normal"]) -> np.ndarray:
    """CIELAB (D65) of sRGB colours as somebody with this sight has them."""
    share = np.asarray(colours) / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    linear = np.clip(linear @ np.asarray(sight).T, 0.0, 1.0)
    to_xyz = np.array(
        [
            [0.4124564, 0.3575761, 0.1804375],
            [0.2126729, 0.7151522, 0.072175],
            [0.0193339, 0.119192, 0.9503041],
        ]
    )
    xyz = linear @ to_xyz.T / [0.95047, 1.0, 1.08883]
    f = np.where(xyz > 216 / 24389, np.cbrt(xyz), (24389 / 27 * xyz + 16.0) / 116.0)
    return np.stack(
        [116.0 * f[:, 1] - 16.0, 500.0 * (f[:, 0] - f[:, 1]), 200.0 * (f[:, 1] - f[:, 2])], axis=1
    )


def least_step(colours: object, sight: object) -> float:
    return float(np.linalg.norm(np.diff(cielab(colours, sight), axis=0), axis=1).min())


def test_a_value_belongs_to_the_class_that_it_reaches() -> None:
    scale = water_scale(WaterColour.DEPTH, 1.0)

    assert scale is not None
    assert scale.class_of([0.0, 0.149, 0.15, 0.3, 0.6, 0.76, 1.5, 2.0, 50.0]).tolist() == [
        0,
        0,
        1,
        2,
        3,
        4,
        5,
        6,
        6,
    ]


def test_limits_are_compared_as_a_picture_compares_them() -> None:
    scale = water_scale(WaterColour.DEPTH, 1.0)
    at_limit = np.float32(0.76)  # below 0.76 in double precision

    assert scale is not None
    assert float(at_limit) < 0.76
    assert scale.class_of(at_limit) == 4
    assert scale.class_of(np.nextafter(at_limit, np.float32(0.0))) == 3


def test_every_class_has_a_colour_and_a_label() -> None:
    for scale in SCALES:
        assert scale is not None
        assert len(scale.colours) == len(scale.labels) == len(scale.limits) + 1
        assert list(scale.limits) == sorted(set(scale.limits))
    assert water_scale(WaterColour.NATURAL, 1.0) is None


@pytest.mark.parametrize("sight", SIGHTS)
def test_neighbouring_classes_stay_apart_for_every_sight(sight: str) -> None:
    for scale in SCALES:
        assert isinstance(scale, ClassScale)
        assert least_step(scale.colours, SIGHTS[sight]) >= LEAST_COLOUR_DISTANCE


def test_a_traffic_light_would_fail_that_test() -> None:
    green_to_orange = [(60, 160, 40), (190, 130, 0), (220, 60, 20)]

    assert least_step(green_to_orange, SIGHTS["normal"]) > 40.0
    assert min(least_step(green_to_orange, SIGHTS[sight]) for sight in SIGHTS) < LEAST_COLOUR_DISTANCE


def test_lightness_runs_in_one_direction() -> None:
    for scale in SCALES:
        assert isinstance(scale, ClassScale)
        steps = np.diff(cielab(scale.colours)[:, 0])
        assert (steps < 0.0).all() or (steps > 0.0).all()


def test_the_hazard_rating_counts_debris_half_in_shallow_water() -> None:
    depth = np.array([0.25, 0.2500001, 1.0, 2.0], np.float32)
    speed = np.array([0.0, 0.0, 1.5, 2.0], np.float32)

    assert hazard_rating(depth, speed).tolist() == pytest.approx([0.625, 1.125, 3.0, 6.0], abs=1e-6)
    scale = water_scale(WaterColour.HAZARD, 1.0)
    assert scale is not None
    assert scale.class_of(hazard_rating(depth, speed)).tolist() == [0, 1, 3, 3]


def test_arrival_classes_span_the_run_in_round_steps() -> None:
    assert arrival_scale(4000.0).limits == (600.0, 1200.0, 1800.0, 2400.0, 3000.0, 3600.0)
    assert arrival_scale(4000.0).labels[0] == "before 10 min"
    assert arrival_scale(4000.0).labels[-1] == "from 1:00 h"
    assert arrival_scale(60.0).labels[1] == "0:10 min - 0:20 min"
    assert arrival_scale(1e7).limits[0] == pytest.approx(1e7 / 7.0)
    assert arrival_scale(4000.0, lambda time: f"t{time:.0f}").labels[1] == "t600 - t1200"


def test_each_way_to_colour_names_the_channel_it_is_read_from() -> None:
    assert WaterColour.DEPTH.channel is None
    assert WaterColour.HAZARD.channel == "velocity"
    assert WaterColour.ARRIVAL.channel == "maxima"


def test_labels_follow_the_units_and_limits_and_ratings_do_not() -> None:
    for colour, heading, first in (
        (WaterColour.DEPTH, "Water depth [ft]", ("< 0.49", "0.49 - 0.98")),
        (WaterColour.MAX_SPEED, "Greatest speed [ft/s]", ("< 0.82", "0.82 - 1.6")),
    ):
        metric, us = (water_scale(colour, 3600.0, None, units) for units in (METRIC, US))
        assert metric is not None
        assert us is not None
        assert (us.heading, us.labels[:2]) == (heading, first)
        assert (us.limits, us.colours) == (metric.limits, metric.colours)
        assert us.labels != metric.labels
    assert water_scale(WaterColour.HAZARD, 1.0, None, US) == water_scale(WaterColour.HAZARD, 1.0)
