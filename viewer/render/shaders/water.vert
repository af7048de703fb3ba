#version 410 core
// The water surface by vertex texture fetch, blended between two frames.
#include "common/frame.glsl"
#include "common/block_vertex.glsl"
uniform sampler2D height;       // ground as drawn, with the preview of edits
uniform sampler2D bed_first;    // bed under the first frame
uniform sampler2D bed_second;
uniform sampler2D depth_first;  // depth continued under dry banks
uniform sampler2D depth_second;
uniform sampler2D slope_first;
uniform sampler2D slope_second;
uniform float alpha;
out vec2 uv;
out vec3 world;
out float depth;
out vec2 slope;
out float clear_air;

// Ground that an edit raised takes depth away at an unchanged level; ground that it lowered keeps the depth.
float drawn(sampler2D depths, sampler2D beds, ivec2 cell, float ground) {
    float raised = max(ground - texelFetch(beds, cell, 0).r, 0.0);
    return texelFetch(depths, cell, 0).r - raised;
}

void main() {
    ivec2 cell = block_vertex();
    float ground = texelFetch(height, cell, 0).r;
    depth = mix(drawn(depth_first, bed_first, cell, ground), drawn(depth_second, bed_second, cell, ground), alpha);
    slope = mix(texelFetch(slope_first, cell, 0).rg, texelFetch(slope_second, cell, 0).rg, alpha);
    uv = (vec2(cell) + 0.5) / grid.xy;
    world = world_of_cell(vec2(cell), ground + depth);
    clear_air = air_transmission(world);
    gl_Position = view_projection * vec4(world, 1.0);
}
