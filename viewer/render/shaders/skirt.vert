#version 410 core
// The walls of the map: of earth below the ground, of water below the surface. One instance is one side of a block.
#include "common/frame.glsl"
#include "common/water_depth.glsl"
in uvec2 in_block;
in uvec2 in_side;            // side (0 west, 1 east, 2 south, 3 north), level of the block
uniform sampler2D height;
uniform int of_water;
out float elevation;
out float below;             // depth below the upper edge [m]
out float clear_air;
flat out vec3 normal;

void main() {
    int stride = int(grid.z);
    ivec2 last = ivec2(blocks.xy);
    int along = ((gl_VertexID >> 1) >> in_side.y) << in_side.y;
    ivec2 cell = min(ivec2(in_block) * stride + (in_side.x < 2u ? ivec2(0, along) : ivec2(along, 0)), last);
    if (in_side.x == 1u) cell.x = last.x;
    if (in_side.x == 3u) cell.y = last.y;
    float ground = texelFetch(height, data_cell(cell), 0).r;
    float top = ground, foot = vertical.w;
    if (of_water != 0) {
        foot = ground;
        top = ground + max(water_depth_of_cell(data_cell(cell), ground), 0.0);
    }
    elevation = (gl_VertexID & 1) == 0 ? top : foot;
    below = top - elevation;
    normal = in_side.x == 0u ? vec3(-1, 0, 0) : in_side.x == 1u ? vec3(1, 0, 0) : in_side.x == 2u ? vec3(0, 0, 1) : vec3(0, 0, -1);
    vec3 world = world_of_cell(vec2(cell), elevation);
    clear_air = air_transmission(world);
    // Walls on the far side of the map face away; only their rim would show, as a ragged line.
    bool faces_eye = dot(normal, eye.xyz - world) > 0.0;
    gl_Position = faces_eye ? view_projection * vec4(world, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
