// Depth of the water to draw, blended between two frames; zero or less under dry ground.
uniform sampler2D bed_first;    // bed under the first frame
uniform sampler2D bed_second;
uniform sampler2D depth_first;  // depth continued under dry banks
uniform sampler2D depth_second;
uniform float alpha;            // 0 shows the first frame, 1 the second

// Ground that an edit raised takes depth away at an unchanged level; ground that it lowered keeps the depth.
// A bed that moves between the frames (a breach) is blended as the depth is, so the level is blended too.
float left_above(float depth, float bed, float ground) {
    return depth - max(ground - bed, 0.0);
}

float water_depth_of_cell(ivec2 cell, float ground) {
    float depth = mix(texelFetch(depth_first, cell, 0).r, texelFetch(depth_second, cell, 0).r, alpha);
    return left_above(depth, mix(texelFetch(bed_first, cell, 0).r, texelFetch(bed_second, cell, 0).r, alpha), ground);
}

float water_depth_at(vec2 uv, float ground) {
    float depth = mix(textureLod(depth_first, uv, 0.0).r, textureLod(depth_second, uv, 0.0).r, alpha);
    float bed = mix(textureLod(bed_first, uv, 0.0).r, textureLod(bed_second, uv, 0.0).r, alpha);
    return left_above(depth, bed, ground);
}

// Depth in the cell as computed, 0 where dry, without a preview of edits.
float computed_depth(ivec2 cell) {
    return mix(max(texelFetch(depth_first, cell, 0).r, 0.0), max(texelFetch(depth_second, cell, 0).r, 0.0), alpha);
}
