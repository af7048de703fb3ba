#version 410 core
// The last pass: the finished picture and the overlay on top of it.
in vec2 place;
uniform sampler2D scene;
uniform sampler2D overlay; // premultiplied alpha
uniform int has_overlay;
out vec4 colour;

void main() {
    vec3 below = texture(scene, place).rgb;
    if (has_overlay != 0) {
        vec4 above = texture(overlay, vec2(place.x, 1.0 - place.y));
        below = above.rgb + (1.0 - above.a) * below;
    }
    colour = vec4(below, 1.0);
}
