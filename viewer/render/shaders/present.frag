#version 410 core
// The finished scene, into the target; greyed when what it shows may be out of date, with a breath of
// colour left so that water stays apart from ground.
in vec2 place;
uniform sampler2D scene;
uniform bool outdated;
out vec4 colour;

void main() {
    vec3 lit = texture(scene, place).rgb;
    float grey = dot(lit, vec3(0.2126, 0.7152, 0.0722));
    vec3 faded = 0.12 + 0.76 * mix(vec3(grey), lit, 0.3);
    colour = vec4(outdated ? faded : lit, 1.0);
}
