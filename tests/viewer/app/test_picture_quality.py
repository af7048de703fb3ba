"""Pictures cost less on a software renderer, and what the user asked for is never sharpened."""

from types import SimpleNamespace

import moderngl
import pytest

from viewer.app.picture_quality import SOFTWARE_SCALE, STILL_SCALE, interactive, is_software, still
from viewer.render import RenderOptions


@pytest.mark.parametrize(
    ("name", "software"),
    [
        ("llvmpipe (LLVM 15.0.6, 256 bits)", True),
        ("softpipe", True),
        ("NVIDIA H200/PCIe/SSE2", False),
        ("Mesa Intel(R) UHD Graphics 620 (KBL GT2)", False),
        ("Apple M2", False),
    ],
)
def test_software_renderers_are_known_by_their_name(name: str, software: bool) -> None:
    assert is_software(SimpleNamespace(info={"GL_RENDERER": name})) is software  # type: ignore[arg-type]


def test_the_name_of_a_real_context_is_read(ctx: moderngl.Context) -> None:
    assert is_software(ctx) is ("llvmpipe" in ctx.info["GL_RENDERER"].lower())


def test_interactive_pictures_are_coarser_and_smaller() -> None:
    options = interactive(RenderOptions())
    assert options.tau_px > RenderOptions().tau_px
    assert options.partial_spacing_px > RenderOptions().partial_spacing_px
    assert options.render_scale == SOFTWARE_SCALE


def test_what_was_chosen_coarser_stays_coarser() -> None:
    chosen = RenderOptions(tau_px=9.0, water_spacing_px=12.0, render_scale=0.5, wireframe=True)
    options = interactive(chosen)
    assert (options.tau_px, options.water_spacing_px, options.render_scale) == (9.0, 12.0, 0.5)
    assert options.wireframe


def test_stills_are_drawn_larger_and_nothing_else_changes() -> None:
    assert still(RenderOptions(tau_px=4.0)) == RenderOptions(tau_px=4.0, render_scale=STILL_SCALE)
