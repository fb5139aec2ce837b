#include "engine/passes/4_sort_tiles.h"

namespace edgesplat::passes {

void sort_tiles(gpu::Commands& commands, const gpu::Buffer& counters, std::uint32_t blocks, std::uint32_t chunk) {
    commands.raw().fillBuffer(counters.handle(), 0, VK_WHOLE_SIZE, 0);
    commands.barrier();
    commands.dispatch("4d_count_tiles.comp", {}, chunk, gpu::groups_for(blocks, 64));
    commands.barrier();
    commands.dispatch("4e_scan_tiles.comp", {}, chunk, {1});
    commands.barrier();
    commands.dispatch("4f_scatter_tiles.comp", {}, chunk, gpu::groups_for(blocks, 64));
    commands.barrier();
}

}  // namespace edgesplat::passes
