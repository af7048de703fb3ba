#version 410 core
#include "common/frame.glsl"
#include "common/ground.glsl"
#include "common/difference.glsl"
#include "common/water_classes.glsl"
in vec2 uv;
in float elevation;
in float clear_air;
flat in float block_shade;
uniform int level;
out vec4 colour;

const vec3 LEVEL_COLOURS[7] = vec3[](
    vec3(0.85, 0.20, 0.20), vec3(0.95, 0.60, 0.20), vec3(0.95, 0.90, 0.30), vec3(0.35, 0.75, 0.35),
    vec3(0.25, 0.65, 0.85), vec3(0.30, 0.35, 0.80), vec3(0.55, 0.30, 0.70));

void main() {
    vec3 ground = ground_at(uv, elevation);
    if (coloured_by == 4) {
        // What a whole run did is told of ground that is dry now, too.
        int k = class_of_whole_run(uv);
        float light = 0.72 + 0.5 * dot(ground, vec3(0.299, 0.587, 0.114));
        if (k != NO_CLASS) ground = mix(ground, class_colours[k] * light, 0.9);
    }
    ground = with_difference(ground, uv);
    if (past_data(uv)) ground = NO_DATA;
    if (picture.w > 0.5) ground = mix(ground, LEVEL_COLOURS[level] * (0.75 + 0.25 * block_shade), 0.55);
    colour = vec4(mix(horizon.rgb, ground, clear_air), 1.0);
}
