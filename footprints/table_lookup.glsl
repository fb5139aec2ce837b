// Reads a footprint from the table's layers. Written in the subset of GLSL that is C++. The includer defines table_texel(x, y,
// layer): the texel's value, x and y counted in texels from the centre of the first. Include after table_layer.glsl.
#ifndef EDGESPLAT_TABLE_LOOKUP_GLSL
#define EDGESPLAT_TABLE_LOOKUP_GLSL

// The column of x in a row, in texels from the centre of the first.
Real footprint_column(FootprintLayer layer, Real x, Real y2) {
    Real across = layer.cosine * sqrt(max(layer.rim2 - y2, 0.0));
    Real ball = sqrt(max(KERNEL_R2 - y2, 0.0));
    Real low = max(layer.middle - across, -ball);
    Real high = max(layer.middle + across, -ball);
    bool before = x < low;
    bool beside = x >= high;
    Real begin = before ? -ball : (beside ? high : low);
    Real end = before ? low : (beside ? max(ball, high) : high);
    Real first = before ? 0.0 : Real(beside ? TABLE_BEFORE + TABLE_ACROSS : TABLE_BEFORE);
    Real last = Real(before ? TABLE_BEFORE : (beside ? TABLE_BESIDE : TABLE_ACROSS)) - 1.0;
    return first + clamp((x - begin) / max(end - begin, 1e-6), 0.0, 1.0) * last;
}

// The footprint of a ray at x along the projected normal; rho2: squared distance from the voxel.
Real footprint_looked_up(FootprintLayer layer, Real x, Real rho2) {
    Real y2 = max(rho2 - x * x, 0.0);
    Real u = footprint_column(layer, x, y2);
    Real v = min(sqrt(y2) * (1.0 / KERNEL_R), 1.0) * Real(TABLE_ROWS - 1u);
    Real first = Real(layer.code & TABLE_MASK);
    Real next = first + Real(TABLE_DIRECTIONS);
    Real to_next = table_blend(layer.code, TABLE_BLEND_BITS);
    Real turned = table_blend(layer.code, 2u * TABLE_BLEND_BITS);
    Real near = mix(table_texel(u, v, first), table_texel(u, v, first + 1.0), turned);
    Real far = mix(table_texel(u, v, next), table_texel(u, v, next + 1.0), turned);
    return mix(near, far, to_next);
}
#endif
