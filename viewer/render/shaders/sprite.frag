#version 410 core
in vec2 place;
uniform sampler2D picture_of_text;
out vec4 colour;

void main() {
    colour = texture(picture_of_text, place);
}
