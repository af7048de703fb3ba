#version 410 core
in vec4 tint;
in float across;
out vec4 colour;

void main() {
    float core = 1.0 - smoothstep(0.45, 0.62, abs(across));
    float fade = 1.0 - smoothstep(0.82, 1.0, abs(across));
    colour = vec4(mix(vec3(0.08), tint.rgb, core), tint.a * fade);
}
