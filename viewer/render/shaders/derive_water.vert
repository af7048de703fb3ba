#version 410 core
// A quad over the vertices of one block, in a picture with one pixel a cell.
in uvec2 in_block;
uniform ivec2 cells;
uniform int stride;

void main() {
    ivec2 first = ivec2(in_block) * stride;
    ivec2 last = min(first + stride + 1, cells);
    ivec2 corner = ivec2(gl_VertexID & 1, gl_VertexID >> 1);
    vec2 place = vec2(mix(vec2(first), vec2(last), vec2(corner))) / vec2(cells);
    gl_Position = vec4(2.0 * place - 1.0, 0.0, 1.0);
}
