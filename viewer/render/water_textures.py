"""Flood frames on the graphics card: depth continued under dry banks, and surface slopes, one pair a frame.

A frame is uploaded and derived once; a picture only blends two of them. Only blocks with water, now or in the
frame that used the textures before, are uploaded and derived.
"""

from __future__ import annotations

from collections.abc import Hashable

import moderngl
import numpy as np
import numpy.typing as npt

from viewer.errors import TerrainDataError
from viewer.lod.block_tiling import BlockTiling, classify_blocks
from viewer.render.frame_inputs import WaterFrame, WaterPair
from viewer.render.ground_textures import height_texture, write_rect
from viewer.render.shader_library import build_program, set_uniforms

__all__ = ["WaterSlot", "WaterTextures", "bind_slots", "combined_states"]

DRY = 0
WIRE_BLOCK_SIZE = 33


class WaterSlot:
    """The textures of one frame."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int], block_count: int) -> None:
        """Allocate."""
        self.depth = ctx.texture(size, 1, dtype="f4")
        self.slope = ctx.texture(size, 2, dtype="f2")
        for texture in (self.depth, self.slope):
            texture.repeat_x = texture.repeat_y = False
            texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        self.framebuffer = ctx.framebuffer([self.depth, self.slope])
        self.key: Hashable = None
        self.z_b: npt.NDArray[np.float32] | None = None
        self.bed: moderngl.Texture | None = None
        self.states = np.full(block_count, 2, dtype=np.uint8)
        self.depth_max = 0.0

    def release(self) -> None:
        """Give the memory back (the bed belongs to `WaterTextures`)."""
        for thing in (self.framebuffer, self.depth, self.slope):
            thing.release()


def bind_slots(program: moderngl.Program, slots: tuple[WaterSlot, WaterSlot], alpha: float, unit: int) -> int:
    """Bind what `common/water_depth.glsl` asks for from a texture unit on, and return the next free one."""
    first, second = slots
    assert first.bed is not None
    assert second.bed is not None
    textures = {
        "bed_first": first.bed,
        "bed_second": second.bed,
        "depth_first": first.depth,
        "depth_second": second.depth,
    }
    for name, texture in textures.items():
        texture.use(unit)
        set_uniforms(program, **{name: unit})
        unit += 1
    set_uniforms(program, alpha=alpha)
    return unit


def combined_states(first: WaterSlot, second: WaterSlot) -> tuple[npt.NDArray[np.uint8], float]:
    """Block states and greatest depth [m] of what lies between two frames.

    A block is dry or wet only if it is so in both; while it changes from one to the other it is partial.
    """
    if first is second:
        return first.states, first.depth_max
    states = np.where(first.states == second.states, first.states, 1).astype(np.uint8)
    return states, max(first.depth_max, second.depth_max)


class WaterTextures:
    """Two slots for the frames around the playback time."""

    def __init__(
        self, ctx: moderngl.Context, tiling: BlockTiling, dx: float, z_b: npt.NDArray[np.float32]
    ) -> None:
        """Compile; textures are made when the first water comes.

        Args:
            ctx: the OpenGL context.
            tiling: the blocks.
            dx: cell size [m].
            z_b: bed of frames that bring none [m], shape [nrows, ncols].
        """
        self._ctx = ctx
        self._tiling = tiling
        self._size = (tiling.ncols, tiling.nrows)
        self._z_b = z_b
        self._beds: dict[int, tuple[npt.NDArray[np.float32], moderngl.Texture]] = {}
        self._slots: list[WaterSlot] = []
        self._staging: moderngl.Texture | None = None
        self._staged = np.zeros(tiling.block_count, dtype=np.bool_)
        self._program = build_program(ctx, "derive_water.vert", "derive_water.frag")
        set_uniforms(self._program, depth=0, bed=1, dx=dx, cells=self._size, stride=tiling.stride)
        rows, cols = np.divmod(np.arange(tiling.block_count), tiling.block_cols)
        self._places = np.stack([cols, rows], axis=1).astype("<u2")
        self._instances = ctx.buffer(reserve=self._places.nbytes, dynamic=True)
        self._array = ctx.vertex_array(self._program, [(self._instances, "2u2 /i", "in_block")])

    def follow(self, pair: WaterPair) -> tuple[WaterSlot, WaterSlot]:
        """The slots of both frames, uploaded and derived if they are new.

        Raises:
            TerrainDataError: if an array does not fit the terrain.
        """
        if self._staging is None:
            self._allocate()
        first = self._slot_of(pair.first, keep=pair.second)
        second = first if pair.second.key == pair.first.key else self._slot_of(pair.second, keep=pair.first)
        self._release_unused_beds()
        return first, second

    def release(self) -> None:
        """Give the memory back."""
        for _, bed in self._beds.values():
            bed.release()
        for slot in self._slots:
            slot.release()
        for thing in (self._staging, self._array, self._instances, self._program):
            if thing is not None:
                thing.release()

    def _allocate(self) -> None:
        self._slots = [WaterSlot(self._ctx, self._size, self._tiling.block_count) for _ in range(2)]
        self._staging = height_texture(
            self._ctx, np.zeros((self._tiling.nrows, self._tiling.ncols), np.float32)
        )

    def _slot_of(self, frame: WaterFrame, keep: WaterFrame) -> WaterSlot:
        z_b = self._z_b if frame.z_b is None else frame.z_b
        for slot in self._slots:
            if slot.bed is not None and slot.key == frame.key and slot.z_b is z_b:
                return slot
        slot = next((slot for slot in self._slots if slot.key != keep.key), self._slots[0])
        self._fill(slot, frame, z_b)
        return slot

    def _fill(self, slot: WaterSlot, frame: WaterFrame, z_b: npt.NDArray[np.float32]) -> None:
        tiling = self._tiling
        for name, array in (("water depth", frame.h), ("bed under water", z_b)):
            if array.shape != (tiling.nrows, tiling.ncols) or array.dtype != np.float32:
                raise TerrainDataError(
                    f"{name} has shape {array.shape} and type {array.dtype}, "
                    f"the terrain asks for {(tiling.nrows, tiling.ncols)} float32"
                )
        states = self._states_of(frame)
        self._stage(frame.h, states)
        bed_changed = slot.z_b is not z_b
        # Blocks that were wet before must be dried; a new bed changes what lies under every bank.
        wanted = (states != DRY) | (slot.states != DRY) | bed_changed
        places = np.ascontiguousarray(self._places[wanted])
        slot.bed = self._bed_texture(z_b)
        if places.size:
            self._instances.orphan(self._places.nbytes)
            self._instances.write(places)
            slot.framebuffer.use()
            slot.framebuffer.viewport = (0, 0, *self._size)
            self._ctx.enable_only(moderngl.NOTHING)
            assert self._staging is not None
            self._staging.use(0)
            slot.bed.use(1)
            self._array.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=len(places))
        slot.key, slot.z_b, slot.states = frame.key, z_b, states
        slot.depth_max = float(frame.h.max())

    def _states_of(self, frame: WaterFrame) -> npt.NDArray[np.uint8]:
        tiling = self._tiling
        if frame.states is None or tiling.block_size != WIRE_BLOCK_SIZE:
            return classify_blocks(frame.h, tiling).ravel()
        # The wire's blocks are ragged; trimmed ones are the first of them.
        blocks = BlockTiling(tiling.nrows, tiling.ncols, WIRE_BLOCK_SIZE)
        if frame.states.shape != (blocks.block_rows, blocks.block_cols):
            raise TerrainDataError(
                f"block states have shape {frame.states.shape}, "
                f"the terrain asks for {(blocks.block_rows, blocks.block_cols)}"
            )
        return frame.states[: tiling.block_rows, : tiling.block_cols].astype(np.uint8, copy=True).ravel()

    def _stage(self, h: npt.NDArray[np.float32], states: npt.NDArray[np.uint8]) -> None:
        """Upload depths, one run of blocks a block row: those with water and those that held some before."""
        tiling = self._tiling
        has_water = states != DRY
        wanted = (has_water | self._staged).reshape(tiling.block_rows, tiling.block_cols)
        assert self._staging is not None
        for row in np.flatnonzero(wanted.any(axis=1)):
            cols = np.flatnonzero(wanted[row])
            rect = (
                int(tiling.row_start[row]),
                int(tiling.col_start[cols[0]]),
                min(int(tiling.row_end[row]) + 1, tiling.nrows),
                min(int(tiling.col_end[cols[-1]]) + 1, tiling.ncols),
            )
            write_rect(self._staging, h, rect)
        self._staged = has_water

    def _bed_texture(self, z_b: npt.NDArray[np.float32]) -> moderngl.Texture:
        kept = self._beds.get(id(z_b))
        if kept is None:
            kept = (z_b, height_texture(self._ctx, z_b))
            self._beds[id(z_b)] = kept
        return kept[1]

    def _release_unused_beds(self) -> None:
        used = {id(slot.z_b) for slot in self._slots}
        for key in [key for key in self._beds if key not in used]:
            self._beds.pop(key)[1].release()
