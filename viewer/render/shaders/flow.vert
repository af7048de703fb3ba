#version 410 core
// An arrow that lies on the water and points with the flow. One instance is one arrow.
#include "common/frame.glsl"
#include "common/water_depth.glsl"
in vec2 in_place;   // east and north of the centre [m]
in vec2 in_along;   // length and direction [m]
in float in_width;  // [m]
uniform sampler2D height;
uniform float rim;  // how much wider than the arrow itself, as a share of its width

// Along (-0.5 to 0.5 of the length) and across (in widths): the shaft, then the head.
const vec2 SHAPE[9] = vec2[](
    vec2(-0.5, -0.14), vec2(0.1, -0.14), vec2(0.1, 0.14), vec2(-0.5, -0.14), vec2(0.1, 0.14), vec2(-0.5, 0.14),
    vec2(0.02, -0.5), vec2(0.5, 0.0), vec2(0.02, 0.5));

void main() {
    vec2 at = SHAPE[gl_VertexID];
    vec2 ahead = normalize(in_along), aside = vec2(-ahead.y, ahead.x);
    float edge = rim * in_width;
    float grown = gl_VertexID < 6 ? sign(at.x + 0.2) : gl_VertexID == 7 ? 2.2 : -1.0;
    vec2 place = in_place + in_along * at.x + ahead * grown * edge
        + aside * (at.y * in_width + sign(at.y) * edge * (gl_VertexID < 6 ? 1.0 : 1.9));
    // Level, at the height of the water in its middle, so that no bank bends it.
    vec2 uv = in_place / (grid.xy * grid.w) + 0.5;
    float z = textureLod(height, uv, 0.0).r;
    z += max(water_depth_at(uv, z), 0.0);
    float up = vertical.y + vertical.x * (z - vertical.y) + 0.3 * in_width;
    vec4 clip = view_projection * vec4(place.x, up, -place.y, 1.0);
    // Nearer by a hair, so that water and banks do not swallow it; the rim stays behind the arrow.
    clip.z -= (rim > 0.0 ? 0.0010 : 0.0014) * clip.w;
    gl_Position = clip;
}
