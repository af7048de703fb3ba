"""Draws the panels over the finished scene; each is made anew only when what it says changes."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from functools import partial

import moderngl
import numpy as np
from PIL import Image

from viewer.render import hud_panels
from viewer.render.frame_inputs import Beside, FrameInputs, HudText
from viewer.render.shader_library import build_program, set_uniforms
from viewer.world.camera import Camera
from viewer.world.flow_arrows import LONGEST_PX, arrow_speed

__all__ = ["HudPass"]

_EDGE = 14
HYPOTHETICAL = "HYPOTHETICAL SCENARIO - NOT A REAL EVENT"


@dataclass
class _Panel:
    says: Hashable
    texture: moderngl.Texture


class HudPass:
    """The panels of a picture."""

    def __init__(self, ctx: moderngl.Context) -> None:
        """Compile."""
        self._ctx = ctx
        self._program = build_program(ctx, "sprite.vert", "sprite.frag")
        set_uniforms(self._program, picture_of_text=0)
        self._array = ctx.vertex_array(self._program, [])
        self._panels: dict[str, _Panel] = {}

    def draw(self, target: moderngl.Framebuffer, size: tuple[int, int], inputs: FrameInputs) -> int:
        """Draw the panels that the inputs ask for, and return the number of draws."""
        hud = inputs.hud
        if hud is None:
            return 0
        target.use()
        target.viewport = (0, 0, *size)
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        scale = min(max(min(size[1] / 720.0, size[0] / 1280.0), 0.6), 3.0)
        edge = round(_EDGE * scale)
        draws = self._draw_marks(inputs, size, scale)
        draws += self._draw_corners(hud, inputs, size, scale, edge)
        draws += self._draw_divider(inputs.beside, size, scale)
        top = edge
        banners = (
            ("notice", hud.notice, True),
            ("hypothetical", HYPOTHETICAL if hud.is_hypothetical else "", False),
        )
        for name, text, alert in banners:
            if text:
                texture = self._panel(
                    name, (text, scale), partial(hud_panels.banner_panel, text, scale, alert)
                )
                left, top = self._beside_text(texture, size, edge, top)
                self._blit(texture, size, left, top)
                top += texture.height + edge // 2
                draws += 1
        return draws

    def release(self) -> None:
        """Give the memory back."""
        for panel in self._panels.values():
            panel.texture.release()
        self._array.release()
        self._program.release()

    def _draw_corners(
        self, hud: HudText, inputs: FrameInputs, size: tuple[int, int], scale: float, edge: int
    ) -> int:
        draws = 0
        if hud.title or hud.time or hud.detail:
            says = (hud.title, hud.time, hud.detail, scale)
            texture = self._panel("text", says, lambda: hud_panels.text_panel(*says))
            self._blit(texture, size, edge, edge)
            draws += 1
        if hud.legend and inputs.water is not None and inputs.options.show_water:
            classes = None if inputs.colouring is None else inputs.colouring.scale
            units = inputs.options.units
            if classes is None:
                make = partial(hud_panels.depth_ramp_panel, scale, units)
            else:
                make = partial(hud_panels.legend_panel, classes, scale)
            texture = self._panel("legend", (classes, scale, units), make)
            self._blit(texture, size, edge, size[1] - texture.height - edge)
            draws += 1
        if inputs.difference is not None:
            other = inputs.difference.other
            says_other = (other, scale, inputs.options.units)
            texture = self._panel("difference", says_other, lambda: hud_panels.difference_panel(*says_other))
            above = self._panels["legend"].texture.height + edge // 2 if "legend" in self._panels else 0
            self._blit(texture, size, edge, size[1] - texture.height - edge - above)
            draws += 1
        if hud.legend and inputs.flow is not None:
            speed = arrow_speed(inputs.flow.fast)
            units, length = inputs.options.units, LONGEST_PX * size[1] / 720.0
            text = f"{units.shown(speed):.3g} {units.speed}"
            texture = self._panel(
                "flow", (text, length, scale), lambda: hud_panels.flow_panel(text, length, scale)
            )
            right = size[0] - texture.width - edge
            self._blit(texture, size, right, size[1] - texture.height - edge - round(66 * scale))
            draws += 1
        if hud.scale_and_north:
            options = inputs.options
            where = _scale_and_bearing(inputs.camera, size)
            says_where = (*where, scale, options.units, options.contour_interval)
            texture = self._panel("scale", says_where, lambda: hud_panels.scale_panel(*says_where))
            self._blit(texture, size, size[0] - texture.width - edge, size[1] - texture.height - edge)
            draws += 1
        return draws

    def _draw_marks(self, inputs: FrameInputs, size: tuple[int, int], scale: float) -> int:
        """Pins at places on the picture; a name that would cover one drawn before is left out."""
        taken: list[tuple[int, int, int, int]] = []
        draws = 0
        for mark in sorted(inputs.marks, key=lambda at: not at.is_chosen):
            seen = inputs.camera.seen_at(mark.point, size[0] / size[1])
            if seen is None or max(map(abs, seen)) > 1.0:
                continue
            x, y = round(0.5 * (1.0 + seen[0]) * size[0]), round(0.5 * (1.0 - seen[1]) * size[1])
            for name in (mark.name, ""):
                says = (name, mark.is_chosen, scale)
                texture = self._panel(f"mark {says}", says, partial(hud_panels.mark_panel, *says))
                left, top = x - texture.width // 2, y - texture.height
                box = (left, top, left + texture.width, y)
                if not any(_overlap(box, other) for other in taken):
                    taken.append(box)
                    self._blit(texture, size, left, top)
                    draws += 1
                    break
        return draws

    def _draw_divider(self, beside: Beside | None, size: tuple[int, int], scale: float) -> int:
        """The line between two runs, with their names on either side of it."""
        if beside is None:
            return 0
        at, thick = round(beside.at * size[0]), max(2, round(3 * scale))
        line = self._panel("divider", (thick, size[1]), lambda: hud_panels.divider_panel(thick, size[1]))
        self._blit(line, size, at - thick // 2, 0)
        gap, top = round(8 * scale), round(140 * scale)
        for name, text in (("left", beside.left), ("right", beside.right)):
            make = partial(hud_panels.banner_panel, text, 0.8 * scale, False)
            label = self._panel(name, (text, scale), make)
            self._blit(label, size, at - gap - label.width if name == "left" else at + gap, top)
        return 3

    def _beside_text(
        self, banner: moderngl.Texture, size: tuple[int, int], edge: int, top: int
    ) -> tuple[int, int]:
        """Left and top of a banner: in the middle, else right of the text panel, else below it."""
        left = (size[0] - banner.width) // 2
        text = self._panels.get("text")
        if text is None or left >= edge + text.texture.width or top >= edge + text.texture.height:
            return left, top
        beside = edge + text.texture.width + edge // 2
        if beside + banner.width + edge <= size[0]:
            return beside, top
        return edge, max(top, edge + text.texture.height + edge // 2)

    def _panel(self, name: str, says: Hashable, make: Callable[[], Image.Image]) -> moderngl.Texture:
        panel = self._panels.get(name)
        if panel is not None and panel.says == says:
            return panel.texture
        pixels = np.asarray(make()).astype(np.uint16)
        pixels[..., :3] = pixels[..., :3] * pixels[..., 3:] // 255  # premultiplied, so that edges filter well
        size = (pixels.shape[1], pixels.shape[0])
        if panel is None or panel.texture.size != size:
            if panel is not None:
                panel.texture.release()
            panel = _Panel(says, self._ctx.texture(size, 4))
            panel.texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            panel.texture.repeat_x = panel.texture.repeat_y = False
            self._panels[name] = panel
        panel.texture.write(pixels.astype(np.uint8))
        panel.says = says
        return panel.texture

    def _blit(self, texture: moderngl.Texture, size: tuple[int, int], left: int, top: int) -> None:
        width, height = size
        window = (
            2.0 * left / width - 1.0,
            1.0 - 2.0 * (top + texture.height) / height,
            2.0 * texture.width / width,
            2.0 * texture.height / height,
        )
        set_uniforms(self._program, window=window)
        texture.use(0)
        self._array.render(moderngl.TRIANGLE_STRIP, vertices=4)


def _overlap(first: tuple[int, int, int, int], second: tuple[int, int, int, int]) -> bool:
    """Whether two boxes (left, top, right, bottom) share a pixel."""
    return first[0] < second[2] and second[0] < first[2] and first[1] < second[3] and second[1] < first[3]


def _scale_and_bearing(camera: Camera, size: tuple[int, int]) -> tuple[float, float]:
    """Metres a pixel at the target, and the bearing, both rounded so that small moves redraw nothing."""
    metres = 2.0 * math.tan(0.5 * camera.fov_y) * camera.distance / size[1]
    return float(f"{metres:.3g}"), float(round(math.degrees(camera.azimuth)))
