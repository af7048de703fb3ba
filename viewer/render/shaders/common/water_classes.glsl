// The class of the water in a cell, by the value of the cell itself and nothing between cells: as the probe reads it.
uniform sampler2D field_first;  // of the first frame: speed [m/s]; or of the whole run, negative where there is none
uniform sampler2D field_second;
uniform int coloured_by;        // 0 nothing, 1 depth, 2 speed, 3 hazard, 4 a field of the whole run
uniform float class_limits[6];
uniform vec3 class_colours[7];

const int NO_CLASS = -1;

ivec2 cell_at(vec2 uv) {
    return clamp(ivec2(floor(uv * grid.xy)), ivec2(0), ivec2(grid.xy) - 1);
}

int class_of(float value) {
    int k = 0;
    for (int limit = 0; limit < 6; ++limit) {
        if (value >= class_limits[limit]) k = limit + 1;
    }
    return k;
}

int class_of_whole_run(vec2 uv) {
    float value = texelFetch(field_first, cell_at(uv), 0).r;
    return value < 0.0 ? NO_CLASS : class_of(value);
}

// FD2320/TR2; the same order of operations as viewer/world/water_scales.py.
float hazard_rating(float depth, float speed) {
    return depth * (speed + 0.5) + (depth <= 0.25 ? 0.5 : 1.0);
}
