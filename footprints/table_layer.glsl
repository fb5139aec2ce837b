// The table of footprints (footprint_table.h): which layers a footprint is blended from, and how it is read from them. Written
// in the subset of GLSL that is C++: shaders include it in float, footprint_table.cpp in double. The includer declares the kernel
// (KERNEL_R, KERNEL_R2), FootprintLayer, the constants of shaders/shared/footprint_table.h and TABLE_MASK: the bits of one blend.
#ifndef EDGESPLAT_TABLE_LAYER_GLSL
#define EDGESPLAT_TABLE_LAYER_GLSL

Real table_blend(uint code, uint bits) { return Real((code >> bits) & TABLE_MASK) * (1.0 / TABLE_BLEND_STEPS); }

// Sine and cosine of an angle from the tangent of its half, and that tangent from the sine.
Real half_sine(Real tangent) { return 2.0 * tangent / (1.0 + tangent * tangent); }
Real half_cosine(Real tangent) { return (1.0 - tangent * tangent) / (1.0 + tangent * tangent); }
Real half_tangent(Real sine) { return sine / (1.0 + sqrt(max(1.0 - sine * sine, 0.0))); }

FootprintLayer decode_footprint_layer(uint code, Real depth) {
    uint layer = code & TABLE_MASK;
    Real to_next = Real(layer / TABLE_DIRECTIONS) + table_blend(code, TABLE_BLEND_BITS);
    Real turned = Real(layer % TABLE_DIRECTIONS) + table_blend(code, 2u * TABLE_BLEND_BITS);
    Real of_distance = 2.0 * to_next / Real(TABLE_DISTANCES - 1u) - 1.0;
    Real of_direction = turned / Real(TABLE_DIRECTIONS - 1u);
    Real rim = KERNEL_R * half_cosine(of_distance);
    FootprintLayer l;
    l.code = code;
    l.middle = (KERNEL_R * half_sine(of_distance) + depth) * half_cosine(of_direction);
    l.cosine = half_sine(of_direction);
    l.rim2 = rim * rim;
    return l;
}

uint select_footprint_layer(Real distance, Real cosine, Real depth) {
    Real e = clamp((distance - depth) / KERNEL_R, -1.0, 1.0);
    Real i = (half_tangent(e) + 1.0) * 0.5 * Real(TABLE_DISTANCES - 1u);
    Real j = half_tangent(clamp(cosine, 0.0, 1.0)) * Real(TABLE_DIRECTIONS - 1u);
    Real i0 = clamp(floor(i), 0.0, Real(TABLE_DISTANCES - 2u));
    Real j0 = clamp(floor(j), 0.0, Real(TABLE_DIRECTIONS - 2u));
    uint to_next = uint(clamp(i - i0, 0.0, 1.0) * TABLE_BLEND_STEPS + 0.5);
    uint turned = uint(clamp(j - j0, 0.0, 1.0) * TABLE_BLEND_STEPS + 0.5);
    return (uint(i0) * TABLE_DIRECTIONS + uint(j0)) | (to_next << TABLE_BLEND_BITS) | (turned << (2u * TABLE_BLEND_BITS));
}
#endif
