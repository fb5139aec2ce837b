// Plans which sheets are drawn together: plan_chunks() (engine/frame/tiles/chunks.h) on the device, so that the
// host does not wait. One workgroup: all invocations load sheets, one processes them. A chunk that exceeds its memory
// stays empty; the host detects this afterwards.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 256) in;
#include "shaders/common/frame.glsl"

const uint SHEETS = gl_WorkGroupSize.x;
shared uint pairs[SHEETS], ends[SHEETS];  // of the sheets being processed

uint chunk_count = 0u, sum = 0u, begin;

void close_chunk(uint end) {
    bool fits = sum <= params.frame.chunk_pairs && end - begin <= params.frame.prepared_mask + 1u;
    if (end > begin && chunk_count < params.frame.chunk_slots)
        PairsRef(params.frame.chunks).at[chunk_count] = fits ? uvec2(begin, end) : uvec2(0u);
    chunk_count += end > begin ? 1u : 0u;
    begin = end;
    sum = 0u;
}

void main() {
    uint me = gl_LocalInvocationIndex, sheets = params.frame.sheet_count;
    UintsRef starts = UintsRef(params.frame.sheet_starts);
    for (uint slot = me; slot < params.frame.chunk_slots; slot += SHEETS) PairsRef(params.frame.chunks).at[slot] = uvec2(0u);
    memoryBarrierBuffer();
    begin = starts.at[0];
    uint last_end = begin;
    for (uint first = 0u; first < sheets; first += SHEETS) {
        uint mine = min(first + me, sheets - 1u), count = min(SHEETS, sheets - first);
        barrier();
        pairs[me] = UintsRef(params.frame.sheet_pairs).at[mine];
        ends[me] = starts.at[mine + 1u];
        barrier();
        if (me == 0u)
            for (uint i = 0u; i < count; ++i) {
                uint room = params.frame.chunk_pairs - min(sum, params.frame.chunk_pairs);
                if (sum > 0u && (pairs[i] > room || ends[i] - begin > params.frame.prepared_mask + 1u)) close_chunk(last_end);
                last_end = ends[i];
                sum += pairs[i];
            }
    }
    if (me == 0u) close_chunk(last_end);
}
