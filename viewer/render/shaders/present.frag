#version 410 core
// The finished scene, into the target; in grey when what it shows may be out of date.
in vec2 place;
uniform sampler2D scene;
uniform bool outdated;
out vec4 colour;

void main() {
    vec3 lit = texture(scene, place).rgb;
    float grey = 0.12 + 0.76 * dot(lit, vec3(0.2126, 0.7152, 0.0722));
    colour = vec4(outdated ? vec3(grey) : lit, 1.0);
}
