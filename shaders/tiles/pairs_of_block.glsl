// Pairs of splats and tiles, PAIR_GROUP entries of `order` at once, a workgroup's: the pairs of its entries are numbered through,
// so that splats of very different size keep all invocations at work.
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 128) in;
layout(binding = BIND_FRAME, scalar) uniform Frame { FrameParams frame; } params;
layout(push_constant) uniform Push { uint chunk; };
#include "shaders/drivers/texels.glsl"
#include "shaders/tiles/tiles_of_splat.glsl"
#include "shaders/common/workgroup_sums.glsl"

const uint PAIR_GROUP = gl_WorkGroupSize.x;
shared uvec4 rects[PAIR_GROUP];  // tiles of each entry: x0, y0, x1, y1, half open

// Entries [base, end), as far as a group goes: how many pairs they have; `sums` says where those of each end.
uint load_pairs(uint base, uint end) {
    uint me = gl_LocalInvocationIndex, entry = base + me;
    uvec4 own = entry < end ? tiles_of(UintsRef(params.frame.order).at[min(entry, end - 1u)]) : uvec4(0u);
    barrier();  // the last entries are done with
    rects[me] = own;
    sum_before((own.z - own.x) * (own.w - own.y));
    return sums[PAIR_GROUP - 1u];
}

struct Pair {
    uint k;     // of the group's entries
    uvec2 tile;
};

Pair pair_of(uint number) {
    uint k = 0u;
    for (uint step = PAIR_GROUP / 2u; step > 0u; step /= 2u) k += sums[k + step - 1u] <= number ? step : 0u;
    uint local = number - (k > 0u ? sums[k - 1u] : 0u), across = rects[k].z - rects[k].x;
    return Pair(k, rects[k].xy + uvec2(local % across, local / across));
}

uint tile_number(uvec2 tile) { return tile.y * uint(params.frame.tiles.x) + tile.x; }
