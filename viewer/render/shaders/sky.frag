#version 410 core
in vec2 place;
uniform samplerCube sky;
uniform mat4 direction_of_place; // clip space to world direction
out vec4 colour;

void main() {
    vec4 far = direction_of_place * vec4(2.0 * place - 1.0, 1.0, 1.0);
    colour = vec4(texture(sky, far.xyz).rgb, 1.0);
}
