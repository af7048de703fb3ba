// Which cell a vertex of a block stands for. One instance is one block.
in uvec2 in_block;      // block column, block row
in uvec4 in_edges;      // level to which the west, east, south and north edge is fitted
uniform int snap_edges; // 0 leaves edges unfitted

ivec2 block_vertex() {
    int stride = int(grid.z);
    int side = stride + 1;
    ivec2 v = ivec2(gl_VertexID % side, gl_VertexID / side);
    if (snap_edges != 0) {
        // A vertex on an edge slides along it to the last vertex that the coarser neighbour has too.
        int w = int(in_edges.x), e = int(in_edges.y), s = int(in_edges.z), n = int(in_edges.w);
        ivec2 local = v;
        if (local.x == 0) v.y = (local.y >> w) << w;
        if (local.x == stride) v.y = (local.y >> e) << e;
        if (local.y == 0) v.x = (local.x >> s) << s;
        if (local.y == stride) v.x = (local.x >> n) << n;
    }
    return min(ivec2(in_block) * stride + v, ivec2(blocks.xy));
}
