// What all passes of one picture share; filled by viewer/render/frame_uniforms.py.
layout(std140) uniform Frame {
    mat4 view_projection;
    vec4 eye;           // xyz: eye in the world [m]
    vec4 sun;           // xyz: unit vector to the sun
    vec4 horizon;       // rgb: colour of far air; w: fog density [1/m], 0 for none
    vec4 grid;          // columns, rows, cells along a block, cell size [m]
    vec4 vertical;      // exaggeration, reference elevation [m], contour interval [m], foot of the skirt [m]
    vec4 picture;       // width, height [pixels], least depth of water shown [m], show blocks (0 or 1)
    vec4 blocks;        // last column and row that blocks reach; more than the grid's where padded
};

// The cell whose values a vertex takes: padding repeats the last one.
ivec2 data_cell(ivec2 cell) {
    return min(cell, ivec2(grid.xy) - 1);
}

// Whether a place lies in padding.
bool past_data(vec2 uv) {
    return any(greaterThan(uv * grid.xy, grid.xy - 0.49));
}

// World position of a cell centre with elevation z.
vec3 world_of_cell(vec2 cell, float z) {
    vec2 centred = (cell - 0.5 * (grid.xy - 1.0)) * grid.w;
    return vec3(centred.x, vertical.y + vertical.x * (z - vertical.y), -centred.y);
}

// How much of a colour the air between lets through.
float air_transmission(vec3 world) {
    float path = distance(world, eye.xyz) * horizon.w;
    return exp(-path * path);
}
