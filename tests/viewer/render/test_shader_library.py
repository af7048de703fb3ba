import moderngl
import pytest

from viewer.errors import ShaderError
from viewer.render.shader_library import build_program, read_shader, set_uniforms


def test_includes_are_pasted_and_lines_keep_their_numbers() -> None:
    text = read_shader("terrain.vert").splitlines()
    outer = read_shader("terrain.vert").split("#line 3\n")[1].splitlines()

    assert text[0] == "#version 410 core"
    assert any(line.startswith("layout(std140) uniform Frame") for line in text)
    assert not any(line.startswith("#include") for line in text)
    assert outer[0] == "#line 1"


def test_a_missing_shader_is_named() -> None:
    with pytest.raises(ShaderError, match=r"no_such\.frag"):
        read_shader("no_such.frag")


def test_a_shader_cannot_be_read_from_outside_the_package() -> None:
    with pytest.raises(ShaderError, match="missing"):
        read_shader("../../../no_such_file")


@pytest.mark.gl
def test_shaders_that_do_not_fit_together_are_named_with_the_drivers_words(ctx: moderngl.Context) -> None:
    # Both declare the uniform `sun`, of two types. A fragment shader in the place of a vertex shader would
    # be a plainer mistake, but Mesa 22 dies of it.
    with pytest.raises(ShaderError, match=r"skirt\.vert with bake_ground\.frag does not compile: (?s:.)+sun"):
        build_program(ctx, "skirt.vert", "bake_ground.frag")


@pytest.mark.gl
def test_uniforms_that_the_compiler_dropped_are_passed_over(ctx: moderngl.Context) -> None:
    program = build_program(ctx, "full_screen.vert", "present.frag")
    set_uniforms(program, scene=3, no_such_uniform=1)

    assert program["scene"].value == 3
    program.release()
