#include "engine/passes/4_sort_tiles.h"

#include <array>

namespace edgesplat::passes {
namespace {

// In the order in which they run. The first of kSideBySide runs only if the device plans the chunks.
constexpr std::array kSideBySide{"4d_plan_chunks.comp", "4d_count_pairs.comp", "4e_sum_tiles.comp",
                                 "4e_place_lists.comp", "4f_scatter_pairs.comp"};
constexpr std::array kInColumns{"4d_count_tiles.comp", "4e_scan_tiles.comp", "4f_scatter_tiles.comp"};

}  // namespace

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
        dispatch(kSideBySide[1], {params.tile_blocks});
        dispatch(kSideBySide[2], commands.groups_for(tiles, 1));
        dispatch(kSideBySide[3], {1});
        dispatch(kSideBySide[4], {params.tile_blocks});
        return;
    }
    const auto run_steps = [&](const char* shader) {
        for (std::uint32_t step = 0; step < steps; ++step)
            dispatch(shader, commands.groups_for(params.tile_blocks, 16));
    };
    run_steps(kInColumns[0]);
    dispatch(kInColumns[1], {1});
    run_steps(kInColumns[2]);
}

void plan_chunks(gpu::Commands& commands) {
    commands.dispatch(kSideBySide[0], {}, 0, {1});
    commands.barrier();
}

std::span<const char* const> sort_tiles_shaders(const gpu::DeviceProfile& profile, bool refined) {
    if (!profile.side_by_side) return kInColumns;
    return std::span<const char* const>(kSideBySide).subspan(refined ? 1 : 0);
}

}  // namespace edgesplat::passes
