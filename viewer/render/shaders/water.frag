#version 410 core
// Reflection of the sky (Schlick 1994) over ground seen through water that darkens it with depth (Beer and Lambert).
#include "common/frame.glsl"
#include "common/ground.glsl"
#include "common/difference.glsl"
#include "common/water_depth.glsl"
#include "common/water_classes.glsl"
in vec2 uv;
in vec3 world;
in float depth;
in vec2 slope;
in float clear_air;
uniform samplerCube sky;
uniform sampler2D ripples;       // slopes of small waves, tiled
out vec4 colour;

const vec3 ABSORPTION = vec3(0.95, 0.38, 0.30); // [1/m]
const vec3 SCATTER_SHALLOW = vec3(0.27, 0.48, 0.53);
const vec3 SCATTER_DEEP = vec3(0.06, 0.21, 0.37);
const float F0 = 0.0204;                        // ((1 - 1.333) / (1 + 1.333))^2

// A cell that is dry, or too thinly wet to be shown, has no class, though the surface of its neighbours may run out over its rim.
int class_here() {
    if (coloured_by == 0) return NO_CLASS;
    if (coloured_by == 4) return class_of_whole_run(uv);
    ivec2 cell = cell_at(uv);
    float h = computed_depth(cell);
    if (h <= 0.0 || h < picture.z) return NO_CLASS;
    if (coloured_by == 1) return class_of(h);
    float speed = mix(texelFetch(field_first, cell, 0).r, texelFetch(field_second, cell, 0).r, alpha);
    return class_of(coloured_by == 2 ? speed : hazard_rating(h, speed));
}

void main() {
    // A film too thin to be shown is drawn as the ground below it: under fully wet blocks there is no other ground.
    if (depth <= 0.0) discard;
    vec3 sight = normalize(world - eye.xyz);
    float far = distance(world, eye.xyz);
    // Small waves fade with distance and in films too thin to carry them.
    float lively = smoothstep(0.0, 0.4, depth) / (1.0 + far / (60.0 * grid.w));
    vec2 small = (texture(ripples, world.xz / 110.0).rg - 0.5) * 0.34 * lively;
    vec3 normal = normalize(vec3(-(slope * vertical.x + small).x, 1.0, -(slope * vertical.x + small).y));

    float facing = clamp(-dot(sight, normal), 0.0, 1.0);
    float once = 1.0 - facing;
    float fresnel = F0 + (1.0 - F0) * once * once * once * once * once;
    float edge = smoothstep(picture.z, picture.z + 0.12, depth);

    // The refracted ray meets the bottom a little farther on.
    vec3 bent = refract(sight, normal, 0.75);
    float path = depth / max(-bent.y, 0.3);
    vec2 shift = bent.xz * min(path, 4.0 * grid.w) * edge;
    vec2 bottom_uv = uv + vec2(shift.x, -shift.y) / (grid.xy * grid.w);
    vec3 bottom = ground_at(bottom_uv, (world.y - vertical.y) / vertical.x + vertical.y - depth);

    vec3 surface;
    int k = class_here();
    if (k != NO_CLASS) {
        // Flat, so that a colour is read off the legend; a little light keeps the surface a surface.
        float shade = 0.96 + 0.10 * (dot(normal, sun.xyz) - sun.y);
        surface = mix(bottom, class_colours[k] * shade, 0.94);
    } else {
        vec3 through = exp(-ABSORPTION * path * 0.75);
        vec3 scatter = mix(SCATTER_SHALLOW, SCATTER_DEEP, 1.0 - exp(-depth * 0.22));
        // Flood water is never clear: even a thin sheet veils the ground, so that its extent can be read from afar.
        through *= 1.0 - 0.38 * edge;
        surface = bottom * through + scatter * (1.0 - through);
        vec3 mirror = reflect(sight, normal);
        mirror.y = abs(mirror.y);
        // The sun's own disc is left to the glint: mirrored in long swells it would blind whole reaches.
        vec3 reflected = min(texture(sky, mirror).rgb, vec3(0.93, 0.95, 0.97));
        float glint = pow(max(dot(mirror, sun.xyz), 0.0), 400.0) * 0.9 * lively;
        surface = mix(surface, reflected, fresnel * edge) + glint * edge * vec3(1.0, 0.95, 0.85);
    }
    surface = with_difference(surface, uv);
    if (past_data(uv)) surface = NO_DATA;
    colour = vec4(mix(horizon.rgb, surface, clear_air), 1.0);
}
