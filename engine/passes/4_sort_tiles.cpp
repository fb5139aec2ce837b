#include "engine/passes/4_sort_tiles.h"

namespace edgesplat::passes {

gpu::Pass sort_tiles(const gpu::DeviceProfile& profile, const shader::FrameParams& params, std::uint32_t chunk,
                     std::uint32_t steps) {
    gpu::Pass pass{"4_sort_tiles", {}};
    if (profile.side_by_side) {
        const auto tiles = static_cast<std::uint64_t>(params.tiles.x) * static_cast<std::uint64_t>(params.tiles.y);
        pass.dispatches = {{"4d_count_pairs.comp", {}, gpu::Columns{params.tile_blocks}, chunk},
                           {"4e_sum_tiles.comp", {}, gpu::Workgroups{tiles}, chunk},
                           {"4e_place_lists.comp", {}, gpu::Columns{1}, chunk},
                           {"4f_scatter_pairs.comp", {}, gpu::Columns{params.tile_blocks}, chunk}};
        return pass;
    }
    const auto run_steps = [&](const char* shader) {
        for (std::uint32_t step = 0; step < steps; ++step)
            pass.dispatches.push_back({shader, {}, gpu::Invocations{params.tile_blocks}, chunk});
    };
    run_steps("4d_count_tiles.comp");
    pass.dispatches.push_back({"4e_scan_tiles.comp", {}, gpu::Columns{1}, chunk});
    run_steps("4f_scatter_tiles.comp");
    return pass;
}

gpu::Pass plan_chunks() {
    return {"4_sort_tiles", {{"4d_plan_chunks.comp", {}, gpu::Columns{1}}}};
}

}  // namespace edgesplat::passes
