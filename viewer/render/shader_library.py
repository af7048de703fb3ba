"""Shaders are files: reading, including, compiling, and errors that name file and line."""

from __future__ import annotations

import re
from importlib import resources

import moderngl

from viewer.errors import ShaderError

__all__ = ["build_program", "read_shader", "set_uniforms"]

_INCLUDE = re.compile(r'^#include "([^"]+)"$')


def read_shader(name: str) -> str:
    """The text of a shader with its includes, each line marked with its own file's numbering.

    Args:
        name: path below `viewer/render/shaders`, with forward slashes.

    Raises:
        ShaderError: if the file, or one that it includes, is missing.
    """
    return "\n".join(_lines(name, [])) + "\n"


def build_program(ctx: moderngl.Context, vertex: str, fragment: str) -> moderngl.Program:
    """Compile and link a program.

    Args:
        ctx: the OpenGL context.
        vertex: file of the vertex shader.
        fragment: file of the fragment shader.

    Raises:
        ShaderError: if it does not compile; the text holds the driver's message.
    """
    try:
        program = ctx.program(vertex_shader=read_shader(vertex), fragment_shader=read_shader(fragment))
    except moderngl.Error as error:
        raise ShaderError(f"{vertex} with {fragment} does not compile: {error}") from error
    block = program.get("Frame", None)
    if isinstance(block, moderngl.UniformBlock):
        block.binding = 0
    return program


def set_uniforms(program: moderngl.Program, **values: object) -> None:
    """Set the uniforms that the compiler kept; those it dropped as unused are passed over."""
    for name, value in values.items():
        uniform = program.get(name, None)
        if isinstance(uniform, moderngl.Uniform):
            uniform.value = value


def _lines(name: str, including: list[str]) -> list[str]:
    if name in including:
        raise ShaderError(f"shader {name} includes itself by way of {' > '.join(including)}")
    path = resources.files("viewer.render").joinpath("shaders", *name.split("/"))
    if not path.is_file():
        raise ShaderError(f"shader file {name} is missing from viewer/render/shaders")
    lines: list[str] = []
    for number, line in enumerate(path.read_text(encoding="ascii").splitlines(), start=1):
        include = _INCLUDE.match(line)
        if include is None:
            lines.append(line)
        else:
            lines += ["#line 1", *_lines(include[1], [*including, name]), f"#line {number + 1}"]
    return lines
