#version 410 core
// A piece of a line laid on the ground, or on the water over it, as a ribbon of constant width on the screen.
// One instance is one piece.
#include "common/frame.glsl"
#include "common/water_depth.glsl"
in vec2 in_start;  // east and north of the centre [m]
in vec2 in_end;
in vec4 in_colour;
uniform sampler2D height;
uniform int over_water;
uniform float width_px;
out vec4 tint;
out float across;

vec4 projected(vec2 place) {
    vec2 uv = place / (grid.xy * grid.w) + 0.5;
    float z = textureLod(height, uv, 0.0).r;
    if (over_water != 0) z += max(water_depth_at(uv, z), 0.0);
    return view_projection * vec4(place.x, vertical.y + vertical.x * (z - vertical.y), -place.y, 1.0);
}

void main() {
    vec4 start = projected(in_start), end = projected(in_end);
    vec2 a = start.xy / max(start.w, 1e-3), b = end.xy / max(end.w, 1e-3);
    vec2 along = (b - a) * picture.xy;
    along /= max(length(along), 1e-6);
    bool at_end = (gl_VertexID & 1) == 1;
    across = (gl_VertexID & 2) == 2 ? 1.0 : -1.0;
    vec4 at = at_end ? end : start;
    vec2 aside = (vec2(-along.y, along.x) * across + along * (at_end ? 0.5 : -0.5)) * width_px / picture.xy;
    at.xy += aside * at.w;
    // Nearer by a hair, so that the ground between its vertices does not swallow the line.
    at.z -= 0.0006 * at.w;
    tint = in_colour;
    gl_Position = (start.w > 0.0 && end.w > 0.0) ? at : vec4(2.0, 2.0, 2.0, 1.0);
}
