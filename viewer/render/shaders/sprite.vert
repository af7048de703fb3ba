#version 410 core
uniform vec4 window; // left, lower, width, height in clip space
out vec2 place;

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    place = vec2(corner.x, 1.0 - corner.y);
    gl_Position = vec4(window.xy + corner * window.zw, 0.0, 1.0);
}
