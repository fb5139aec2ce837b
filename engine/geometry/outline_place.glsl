// The place of an outline in a pixel. Written in the subset of GLSL that is C++.
#ifndef EDGESPLAT_OUTLINE_PLACE_GLSL
#define EDGESPLAT_OUTLINE_PLACE_GLSL

// Lengths are pixels, along an axis.
struct OutlinePlace {
    bool there;   // the outline is less than a pixel from the pixel's centre
    Real level;   // distance of the centre outside it; negative: in the matter
    Real offset;  // from the centre to the outline
    bool down;    // the axis: downwards, else to the right
};

// The matter lies where `level` < 0; `rate`: change of `level` per pixel to the right and down.
OutlinePlace outline_place(Real level, vec2 rate) {
    OutlinePlace place;
    place.down = abs(rate.y) > abs(rate.x);
    Real along = place.down ? rate.y : rate.x;
    place.level = level / abs(along);
    place.offset = -level / along;
    place.there = abs(place.level) < 1.0;
    return place;
}
#endif
