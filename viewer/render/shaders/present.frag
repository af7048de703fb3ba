#version 410 core
// The finished scene, into the target.
in vec2 place;
uniform sampler2D scene;
out vec4 colour;

void main() {
    colour = vec4(texture(scene, place).rgb, 1.0);
}
