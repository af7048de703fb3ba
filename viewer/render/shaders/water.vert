#version 410 core
// The water surface by vertex texture fetch, blended between two frames.
#include "common/frame.glsl"
#include "common/block_vertex.glsl"
#include "common/water_depth.glsl"
uniform sampler2D height;       // ground as drawn, with the preview of edits
uniform sampler2D slope_first;
uniform sampler2D slope_second;
out vec2 uv;
out vec3 world;
out float depth;
out vec2 slope;
out float clear_air;

void main() {
    ivec2 cell = block_vertex();
    ivec2 data = data_cell(cell);
    float ground = texelFetch(height, data, 0).r;
    depth = water_depth_of_cell(data, ground);
    slope = mix(texelFetch(slope_first, data, 0).rg, texelFetch(slope_second, data, 0).rg, alpha);
    uv = (vec2(cell) + 0.5) / grid.xy;
    world = world_of_cell(vec2(cell), ground + depth);
    clear_air = air_transmission(world);
    gl_Position = view_projection * vec4(world, 1.0);
}
