#version 410 core
// From depth and bed of one frame: the depth to draw, continued under dry banks, and the slope of the surface.
//
// A dry cell beside water gets the depth, zero or less, that continues the level of its wet neighbours into the
// ground, so that the drawn surface runs into the bank and the shore lies where it meets the ground between cells.
// Where water stands higher than a dry cell (a front running downhill) the depth there is 0.
uniform sampler2D depth;
uniform sampler2D bed;
uniform float dx;
uniform ivec2 cells;
layout(location = 0) out float drawn_depth;
layout(location = 1) out vec2 slope; // d eta / d east, d eta / d south [1]

float depth_at(ivec2 c) { return texelFetch(depth, clamp(c, ivec2(0), cells - 1), 0).r; }
float bed_at(ivec2 c) { return texelFetch(bed, clamp(c, ivec2(0), cells - 1), 0).r; }

// Level of a neighbour; a dry one takes the level of the centre (Shankel 2002, as in the FEV frontend).
float level_at(ivec2 c, float centre) {
    float h = depth_at(c);
    return h > 0.0 ? bed_at(c) + h : centre;
}

void main() {
    ivec2 c = ivec2(gl_FragCoord.xy);
    float z = bed_at(c);
    drawn_depth = depth_at(c);
    float eta = z + drawn_depth;
    if (drawn_depth <= 0.0) {
        float sum = 0.0, count = 0.0;
        for (int j = -1; j <= 1; ++j) {
            for (int i = -1; i <= 1; ++i) {
                ivec2 near = c + ivec2(i, j);
                float h = depth_at(near);
                if (h > 0.0) {
                    sum += bed_at(near) + h;
                    count += 1.0;
                }
            }
        }
        if (count > 0.0) {
            eta = sum / count;
            drawn_depth = min(eta - z, 0.0);
        }
    }
    float w = level_at(c - ivec2(1, 0), eta), e = level_at(c + ivec2(1, 0), eta);
    float s = level_at(c - ivec2(0, 1), eta), n = level_at(c + ivec2(0, 1), eta);
    slope = vec2(e - w, s - n) / (2.0 * dx);
}
