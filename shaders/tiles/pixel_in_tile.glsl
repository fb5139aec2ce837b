// Consecutive numbers form compact blocks: 8 are 4 x 2 pixels, 16 are 4 x 4, 32 are 8 x 4, 64 are 8 x 8.
ivec2 pixel_in_tile(uint i) {
    return ivec2((i & 3u) | (i >> 2 & 4u) | (i >> 3 & 8u), (i >> 2 & 1u) | (i >> 2 & 2u) | (i >> 3 & 4u) | (i >> 4 & 8u));
}
