import dataclasses

import numpy as np
import pytest

from viewer.render import EditOverlay, FrameInputs, RenderOptions
from viewer.render.frame_inputs import same_marks
from viewer.world import Camera


def test_inputs_cannot_change_while_a_picture_is_drawn() -> None:
    inputs = FrameInputs(Camera((0.0, 0.0, 0.0), 10.0, 0.0, 0.5))

    with pytest.raises(dataclasses.FrozenInstanceError):
        inputs.water = None  # type: ignore[misc]
    with pytest.raises(dataclasses.FrozenInstanceError):
        inputs.options.tau_px = 5.0  # type: ignore[misc]


def test_the_defaults_are_those_of_the_design() -> None:
    options = RenderOptions()

    assert options.tau_px == 2.0
    assert options.exaggeration == 1.0
    assert options.partial_spacing_px == 0.0  # an exact shore: every vertex of partial blocks is drawn


def test_marks_are_the_same_only_for_the_same_array_and_revision() -> None:
    sign = np.zeros((3, 3), dtype=np.int8)

    assert same_marks(None, None)
    assert same_marks(EditOverlay(1, sign), EditOverlay(1, sign))
    assert not same_marks(EditOverlay(1, sign), None)
    assert not same_marks(EditOverlay(1, sign), EditOverlay(2, sign))
    assert not same_marks(EditOverlay(1, sign), EditOverlay(1, sign.copy()))
