"""The values by which water is coloured, on the graphics card: one float a cell, uploaded once a frame."""

from __future__ import annotations

from collections.abc import Hashable

import moderngl
import numpy as np

from viewer.errors import TerrainDataError
from viewer.render.frame_inputs import CellField, Colouring
from viewer.render.shader_library import set_uniforms
from viewer.world.water_scales import WaterColour

__all__ = ["ColouringTextures"]

_UNITS = (13, 14)
"""Texture units after those of ground, water and difference."""
_CLASSES_MOST = 7
_NOTHING, _DEPTH, _SPEED, _HAZARD, _WHOLE_RUN = range(5)
_KINDS = {
    WaterColour.NATURAL: _NOTHING,
    WaterColour.DEPTH: _DEPTH,
    WaterColour.SPEED: _SPEED,
    WaterColour.HAZARD: _HAZARD,
}


class _Slot:
    def __init__(self, texture: moderngl.Texture) -> None:
        self.texture = texture
        self.key: Hashable = None


class ColouringTextures:
    """Follows the colouring of the frame inputs; holds single cells while it needs no values."""

    def __init__(self, ctx: moderngl.Context, shape: tuple[int, int]) -> None:
        """Begin with natural water.

        Args:
            ctx: the OpenGL context.
            shape: rows and columns of the terrain.
        """
        self._ctx = ctx
        self._shape = shape
        self._slots = [_Slot(self._texture((1, 1))) for _ in _UNITS]
        self._bound = (self._slots[0], self._slots[1])
        self._colouring: Colouring | None = None

    def follow(self, colouring: Colouring | None) -> None:
        """Upload the values that are new.

        Raises:
            TerrainDataError: a field does not fit the terrain.
        """
        self._colouring = colouring
        if colouring is None or not colouring.fields:
            return
        first, second = colouring.fields[0], colouring.fields[-1]
        first_slot = self._slot_of(first, keep=second)
        self._bound = (first_slot, first_slot if second.key == first.key else self._slot_of(second, first))

    def bind(self, program: moderngl.Program) -> None:
        """Bind what `shaders/common/water_classes.glsl` asks for."""
        for slot, unit, name in zip(self._bound, _UNITS, ("field_first", "field_second"), strict=True):
            slot.texture.use(unit)
            set_uniforms(program, **{name: unit})
        colouring = self._colouring
        if colouring is None:
            set_uniforms(program, coloured_by=_NOTHING)
            return
        scale = colouring.scale
        spare = _CLASSES_MOST - len(scale.colours)
        set_uniforms(
            program,
            coloured_by=_KINDS.get(colouring.colour, _WHOLE_RUN),
            class_limits=[*scale.limits, *[np.inf] * spare],
            class_colours=[tuple(c / 255.0 for c in colour) for colour in scale.colours]
            + [(0.0,) * 3] * spare,
        )

    def release(self) -> None:
        """Give the memory back."""
        for slot in self._slots:
            slot.texture.release()

    def _slot_of(self, field: CellField, keep: CellField) -> _Slot:
        for slot in self._slots:
            if slot.key == field.key:
                return slot
        slot = next((slot for slot in self._slots if slot.key != keep.key), self._slots[0])
        values = np.ascontiguousarray(field.values, dtype=np.float32)
        if values.shape != self._shape:
            raise TerrainDataError(f"{field.key} has shape {values.shape}, the terrain has {self._shape}")
        size = (self._shape[1], self._shape[0])
        if slot.texture.size != size:
            slot.texture.release()
            slot.texture = self._texture(size)
        slot.texture.write(values)
        slot.key = field.key
        return slot

    def _texture(self, size: tuple[int, int]) -> moderngl.Texture:
        texture = self._ctx.texture(size, 1, dtype="f4")
        texture.repeat_x = texture.repeat_y = False
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture
