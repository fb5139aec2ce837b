// Pairs of splats and tiles of PAIR_GROUP entries of `order`, processed by one workgroup. The pairs are numbered
// consecutively, so that all invocations work although splats differ in size.
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 128) in;
#include "shaders/common/frame.glsl"
layout(push_constant) uniform Push { uint chunk; };
#include "shaders/drivers/texels.glsl"
#include "shaders/tiles/tiles_of_splat.glsl"
#include "shaders/common/workgroup_sums.glsl"

const uint PAIR_GROUP = gl_WorkGroupSize.x;
shared uvec4 rects[PAIR_GROUP];  // tiles of each entry: x0, y0, x1, y1, half open

// Loads the group's entries from `base`, up to `end`; returns their number of pairs. `sums` contains the end of each
// entry's pairs.
uint load_pairs(uint base, uint end) {
    uint me = gl_LocalInvocationIndex, entry = base + me;
    uvec4 own = entry < end ? tiles_of(UintsRef(params.frame.order).at[min(entry, end - 1u)]) : uvec4(0u);
    barrier();  // the previous entries are no longer used
    rects[me] = own;
    sum_before((own.z - own.x) * (own.w - own.y));
    return sums[PAIR_GROUP - 1u];
}

struct Pair {
    uint k;     // index among the group's entries
    uvec2 tile;
};

Pair pair_of(uint number) {
    uint k = 0u;
    for (uint step = PAIR_GROUP / 2u; step > 0u; step /= 2u) k += sums[k + step - 1u] <= number ? step : 0u;
    uint local = number - (k > 0u ? sums[k - 1u] : 0u), across = rects[k].z - rects[k].x;
    return Pair(k, rects[k].xy + uvec2(local % across, local / across));
}

uint tile_number(uvec2 tile) { return tile.y * uint(params.frame.tiles.x) + tile.x; }
