// Where another run has less or more water: deeper here in purple, shallower here in green, ground and water alike.
uniform sampler2D difference;  // (depth here - depth there) / difference_range, 0.5 where equal
uniform int has_difference;
uniform float difference_range; // [m]

const vec3 DEEPER_LIGHT = vec3(0.91, 0.58, 0.80);
const vec3 DEEPER_DARK = vec3(0.62, 0.05, 0.42);
const vec3 SHALLOWER_LIGHT = vec3(0.70, 0.87, 0.50);
const vec3 SHALLOWER_DARK = vec3(0.18, 0.47, 0.07);

vec3 with_difference(vec3 colour, vec2 uv) {
    if (has_difference == 0) return colour;
    float metres = (texture(difference, uv).r * 255.0 - 128.0) / 127.0 * difference_range;
    float size = abs(metres);
    float depth = smoothstep(0.05, 1.0, size);
    vec3 tint = metres > 0.0 ? mix(DEEPER_LIGHT, DEEPER_DARK, depth) : mix(SHALLOWER_LIGHT, SHALLOWER_DARK, depth);
    float light = 0.62 + 0.55 * dot(colour, vec3(0.299, 0.587, 0.114));
    return mix(colour, tint * light, 0.88 * smoothstep(0.02, 0.06, size));
}
