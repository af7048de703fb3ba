#version 410 core
#include "common/frame.glsl"
#include "common/block_vertex.glsl"
uniform sampler2D height;
out vec2 uv;
out float elevation;
out float clear_air;
flat out float block_shade;

void main() {
    ivec2 cell = block_vertex();
    elevation = texelFetch(height, data_cell(cell), 0).r;
    uv = (vec2(cell) + 0.5) / grid.xy;
    vec3 world = world_of_cell(vec2(cell), elevation);
    clear_air = air_transmission(world);
    block_shade = float((in_block.x + in_block.y) % 2u);
    gl_Position = view_projection * vec4(world, 1.0);
}
