#include "engine/passes/4_sort_tiles.h"

namespace edgesplat::passes {

void sort_tiles(gpu::Commands& commands, const gpu::Buffer& counters, std::uint32_t blocks, std::uint32_t chunk,
                std::uint32_t steps) {
    const auto go_through = [&](const char* shader) {
        for (std::uint32_t step = 0; step < steps; ++step) {
            commands.dispatch(shader, {}, chunk, gpu::groups_for(blocks, 16));
            commands.barrier();
        }
    };
    commands.fill(counters, 0);
    commands.barrier();
    go_through("4d_count_tiles.comp");
    commands.dispatch("4e_scan_tiles.comp", {}, chunk, {1});
    commands.barrier();
    go_through("4f_scatter_tiles.comp");
}

}  // namespace edgesplat::passes
