#include "engine/passes/4_sort_tiles.h"

namespace edgesplat::passes {

void sort_tiles(gpu::Commands& commands, const gpu::Buffer& counters, const shader::FrameParams& params,
                std::uint32_t chunk, std::uint32_t steps) {
    commands.fill(counters, 0);
    commands.barrier();
    const auto dispatch = [&](const char* shader, gpu::Groups groups) {
        commands.dispatch(shader, {}, chunk, groups);
        commands.barrier();
    };
    if (commands.profile().side_by_side) {
        const auto tiles = static_cast<std::uint64_t>(params.tiles.x) * static_cast<std::uint64_t>(params.tiles.y);
        dispatch("4d_count_pairs.comp", {params.tile_blocks});
        dispatch("4e_sum_tiles.comp", gpu::groups_for(tiles, 1));
        dispatch("4e_place_lists.comp", {1});
        dispatch("4f_scatter_pairs.comp", {params.tile_blocks});
        return;
    }
    const auto go_through = [&](const char* shader) {
        for (std::uint32_t step = 0; step < steps; ++step)
            dispatch(shader, gpu::groups_for(params.tile_blocks, 16));
    };
    go_through("4d_count_tiles.comp");
    dispatch("4e_scan_tiles.comp", {1});
    go_through("4f_scatter_tiles.comp");
}

void plan_chunks(gpu::Commands& commands) {
    commands.dispatch("4d_plan_chunks.comp", {}, 0, {1});
    commands.barrier();
}

std::string sort_tiles_shaders(const gpu::DeviceProfile& profile) {
    return profile.side_by_side ? "4d_count_pairs.comp, 4e_sum_tiles.comp, 4e_place_lists.comp, 4f_scatter_pairs.comp"
                                : "4d_count_tiles.comp, 4e_scan_tiles.comp, 4f_scatter_tiles.comp";
}

}  // namespace edgesplat::passes
