#version 410 core
// Bakes colour times light of the ground into a texture, so that each level of detail is lit alike.
in vec2 place;
uniform sampler2D height;      // R32F, elevation [m]
uniform sampler2D imagery;
uniform int has_imagery;
uniform vec2 cells;            // columns, rows
uniform float dx;              // [m]
uniform vec3 sun;              // unit vector to the sun, world axes
uniform vec2 elevation_range;  // lowest and highest ground that is tinted [m]
uniform sampler2D outside;     // 1 in cells without data
uniform int has_outside;
uniform vec4 window;           // part of the texture being baked: origin and size, 0 to 1
out vec4 colour;

const vec3 NO_DATA = vec3(0.55, 0.56, 0.57);

// Hypsometric tints of the ground, low to high.
const int TINTS = 7;
const vec3 TINT[TINTS] = vec3[](
    vec3(0.47, 0.55, 0.34), vec3(0.54, 0.60, 0.37), vec3(0.62, 0.64, 0.42), vec3(0.66, 0.63, 0.45),
    vec3(0.62, 0.57, 0.43), vec3(0.58, 0.53, 0.44), vec3(0.68, 0.65, 0.60));

vec3 hypsometric(float t) {
    float at = clamp(t, 0.0, 1.0) * float(TINTS - 1);
    int low = min(int(at), TINTS - 2);
    return mix(TINT[low], TINT[low + 1], smoothstep(0.0, 1.0, at - float(low)));
}

float ground(vec2 uv) {
    return texture(height, uv).r;
}

// Catmull-Rom-like smoothing by four bilinear taps (Sigg and Hadwiger 2005, cubic B-spline).
float smooth_ground(vec2 uv) {
    vec2 p = uv * cells - 0.5;
    vec2 f = fract(p);
    vec2 i = p - f;
    vec2 f2 = f * f, f3 = f2 * f;
    vec2 w0 = (1.0 - f) * (1.0 - f) * (1.0 - f) / 6.0;
    vec2 w1 = (4.0 - 6.0 * f2 + 3.0 * f3) / 6.0;
    vec2 w3 = f3 / 6.0;
    vec2 w2 = 1.0 - w0 - w1 - w3;
    vec2 g0 = w0 + w1, g1 = w2 + w3;
    vec2 a = (i + w1 / g0 - 0.5) / cells;
    vec2 b = (i + w3 / g1 + 1.5) / cells;
    return g0.y * (g0.x * ground(a) + g1.x * ground(vec2(b.x, a.y)))
         + g1.y * (g0.x * ground(vec2(a.x, b.y)) + g1.x * ground(b));
}

float hash(vec2 p) {
    vec3 q = fract(vec3(p.xyx) * 0.1031);
    q += dot(q, q.yzx + 33.33);
    return fract((q.x + q.y) * q.z);
}

float noise(vec2 p) {
    vec2 i = floor(p), f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x), mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y);
}

// How much of the sun is seen past the hills toward it, soft at the edge.
float sunlight(vec2 uv, float z) {
    float flat_length = length(sun.xz);
    if (flat_length < 1e-3) return 1.0;
    vec2 toward = vec2(sun.x, -sun.z) / flat_length;
    float rise = sun.y / flat_length;
    float lit = 1.0;
    float reach = 1.5;
    for (int k = 0; k < 24; ++k) {
        vec2 at = uv + toward * reach / cells;
        if (at.x < 0.0 || at.y < 0.0 || at.x > 1.0 || at.y > 1.0) break;
        float clearance = z + rise * reach * dx - ground(at);
        lit = min(lit, 0.5 + clearance / (0.08 * reach * dx));
        reach *= 1.22;
    }
    return clamp(lit, 0.0, 1.0);
}

void main() {
    vec2 uv = window.xy + place * window.zw;
    vec2 texel = 1.0 / cells;
    float z = smooth_ground(uv);
    float e = smooth_ground(uv + vec2(texel.x, 0.0)), w = smooth_ground(uv - vec2(texel.x, 0.0));
    float n = smooth_ground(uv + vec2(0.0, texel.y)), s = smooth_ground(uv - vec2(0.0, texel.y));
    vec3 normal = normalize(vec3(w - e, 2.0 * dx, n - s));

    vec3 albedo;
    if (has_imagery != 0) {
        albedo = texture(imagery, uv).rgb;
    } else {
        float t = (z - elevation_range.x) / max(elevation_range.y - elevation_range.x, 1.0);
        vec2 metres = uv * cells * dx;
        float patches = noise(metres / 160.0) * 0.55 + noise(metres / 53.0) * 0.3 + noise(metres / 17.0) * 0.15;
        albedo = hypsometric(sqrt(max(t, 0.0)) + 0.10 * (patches - 0.5));
        float steepness = 1.0 - normal.y;
        // Slopes too steep to plough are wooded, cliffs are bare.
        albedo = mix(albedo, vec3(0.38, 0.45, 0.29), 0.75 * smoothstep(0.012, 0.07, steepness));
        albedo = mix(albedo, vec3(0.52, 0.48, 0.43), smoothstep(0.16, 0.40, steepness));
        albedo *= 0.88 + 0.24 * patches;
    }

    // Sky light by openness: hollows darker, ridges lighter, at three scales.
    float open = 0.0;
    for (int k = 0; k < 3; ++k) {
        float r = 3.0 * pow(3.0, float(k));
        float around = 0.25 * (ground(uv + vec2(r, 0.0) * texel) + ground(uv - vec2(r, 0.0) * texel)
                             + ground(uv + vec2(0.0, r) * texel) + ground(uv - vec2(0.0, r) * texel));
        open += clamp((z - around) / (r * dx), -0.35, 0.35);
    }
    float sky = clamp(0.92 + 0.55 * open, 0.45, 1.2);
    float direct = max(dot(normal, sun), 0.0) * sunlight(uv, z);
    vec3 light = direct * vec3(1.06, 0.99, 0.88) * 0.98 + sky * (0.62 + 0.38 * normal.y) * vec3(0.36, 0.41, 0.50);
    float data = has_outside != 0 ? 1.0 - texture(outside, uv).r : 1.0;
    // Level, unlit grey: nobody is to take it for ground.
    colour = vec4(mix(NO_DATA, albedo * light, data), data * (has_imagery != 0 ? 0.5 : 1.0));
}
