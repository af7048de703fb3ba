#version 410 core
#include "common/frame.glsl"
in float elevation;
in float below;
in float clear_air;
flat in vec3 normal;
uniform int of_water;
out vec4 colour;

void main() {
    float light = 0.62 + 0.38 * max(dot(normal, sun.xyz), 0.0);
    vec3 wall;
    if (of_water != 0) {
        wall = mix(vec3(0.20, 0.46, 0.55), vec3(0.04, 0.19, 0.34), 1.0 - exp(-below * 0.15)) * (0.4 + 0.6 * light);
    } else {
        float layer = 0.5 + 0.5 * sin(elevation * 0.35 + 2.0 * sin(elevation * 0.11));
        wall = mix(vec3(0.40, 0.33, 0.26), vec3(0.50, 0.43, 0.35), 0.5 * layer) * light;
        wall = mix(vec3(0.34, 0.36, 0.22) * light, wall, clamp(below / 6.0, 0.0, 1.0));
    }
    colour = vec4(mix(horizon.rgb, wall, clear_air), 1.0);
}
