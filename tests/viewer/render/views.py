"""Cameras and options that the picture tests share."""

import math

import numpy as np

from viewer.world import Camera, overview

MAGENTA = (1.0, 0.0, 1.0)
BARE = {"show_sky": False, "show_skirt": False, "fog": False, "background": MAGENTA}

INSIDE = [
    Camera((0.0, 20.0, 0.0), 260.0, 0.4, math.radians(45.0)),
    Camera((300.0, 20.0, 200.0), 330.0, 2.4, math.radians(52.0)),
    Camera((-400.0, 20.0, -100.0), 200.0, -1.7, math.radians(60.0)),
    Camera((100.0, 20.0, -300.0), 500.0, 4.0, math.radians(48.0)),
]
"""Steep views inside the map: no sky, no border."""

VIEWS = [*INSIDE, overview(3210.0, 2570.0, 20.0), Camera((0.0, 40.0, 0.0), 700.0, 0.9, math.radians(14.0))]


def magenta_pixels(picture: np.ndarray) -> int:
    return int((picture == [255, 0, 255]).all(axis=2).sum())
