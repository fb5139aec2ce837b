// Reads footprints from the table's layers: the float32 mirror of FootprintTable::lookup in
// footprints/footprint_table.h. Include after shaders/footprints/footprint_layer.glsl. Written in the subset of GLSL
// that is also C++. The including shader defines table_texel(x, y, layer): the texel's value, x and y counted in texels
// from the centre of the first.
#ifndef EDGESPLAT_FOOTPRINT_TABLE_GLSL
#define EDGESPLAT_FOOTPRINT_TABLE_GLSL

// The column of x in a row, in texels from the centre of the first.
float footprint_column(FootprintLayer layer, float x, float y2) {
    float across = layer.cosine * sqrt(max(layer.rim2 - y2, 0.0));
    float ball = sqrt(max(KERNEL_R2 - y2, 0.0));
    float low = max(layer.middle - across, -ball);
    float high = max(layer.middle + across, -ball);
    bool before = x < low;
    bool beside = x >= high;
    float begin = before ? -ball : (beside ? high : low);
    float end = before ? low : (beside ? max(ball, high) : high);
    float first = before ? 0.0 : float(beside ? TABLE_BEFORE + TABLE_ACROSS : TABLE_BEFORE);
    float last = float(before ? TABLE_BEFORE : (beside ? TABLE_BESIDE : TABLE_ACROSS)) - 1.0;
    return first + clamp((x - begin) / max(end - begin, 1e-6), 0.0, 1.0) * last;
}

// The footprint of a ray at x along the projected normal; rho2: squared distance from the voxel.
float footprint_looked_up(FootprintLayer layer, float x, float rho2) {
    float y2 = max(rho2 - x * x, 0.0);
    float u = footprint_column(layer, x, y2);
    float v = min(sqrt(y2) * (1.0 / KERNEL_R), 1.0) * float(TABLE_ROWS - 1u);
    float first = float(layer.code & TABLE_MASK);
    float next = first + float(TABLE_DIRECTIONS);
    float to_next = table_blend(layer.code, TABLE_BLEND_BITS);
    float turned = table_blend(layer.code, 2u * TABLE_BLEND_BITS);
    float near = mix(table_texel(u, v, first), table_texel(u, v, first + 1.0), turned);
    float far = mix(table_texel(u, v, next), table_texel(u, v, next + 1.0), turned);
    return mix(near, far, to_next);
}
#endif
