// The colour of the ground, lit, with edit marks and contour lines; the same for dry ground and for a river's bottom.
uniform sampler2D ground_colour; // baked: colour times light; alpha: 0 no data, 0.5 plain, 1 takes grain
uniform sampler2D edit_mask;     // 0 lowered, 0.5 untouched, 1 raised
uniform sampler2D detail;        // grain of the ground near the eye, 0.5 on average
uniform int has_edits;

const vec3 RAISED = vec3(0.93, 0.45, 0.10);
const vec3 NO_DATA = vec3(0.55, 0.56, 0.57);
const vec3 LOWERED = vec3(0.16, 0.36, 0.85);

vec3 ground_at(vec2 uv, float elevation) {
    vec4 baked = texture(ground_colour, uv);
    float grain = max(2.0 * baked.a - 1.0, 0.0), data = min(2.0 * baked.a, 1.0);
    vec3 colour = baked.rgb * (1.0 + grain * 0.32 * (texture(detail, uv * grid.xy / 48.0).r - 0.5));
    if (has_edits != 0) {
        float mark = texture(edit_mask, uv).r * (255.0 / 127.0) - 128.0 / 127.0;
        float light = 0.45 + 0.75 * dot(colour, vec3(0.299, 0.587, 0.114));
        colour = mix(colour, (mark > 0.0 ? RAISED : LOWERED) * light, 0.8 * clamp(abs(mark), 0.0, 1.0));
    }
    if (vertical.z > 0.0) {
        float turns = elevation / vertical.z;
        float slope = max(fwidth(turns), 1e-6);
        float line = 1.0 - smoothstep(0.5, 1.3, abs(fract(turns - 0.5) - 0.5) / slope);
        float index = abs(fract(turns / 5.0 - 0.5) - 0.5) * 5.0 < 0.5 ? 1.0 : 0.0;
        // Lines closer than a few pixels would only darken the slope.
        line *= data * (0.30 + 0.30 * index) * (1.0 - smoothstep(0.15, 0.4, slope));
        colour = mix(colour, vec3(0.23, 0.15, 0.08), line);
    }
    return colour;
}
