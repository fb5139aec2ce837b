#include "engine/passes/4_sort_sheets.h"

namespace edgesplat::passes {
namespace {

bool side_by_side(const DrawVariant& variant, const gpu::DeviceProfile& profile) {
    return profile.side_by_side && variant.tiles;
}

}  // namespace

std::vector<SortStep> sort_sheets_steps(const DrawVariant& variant, const gpu::DeviceProfile& profile) {
    const gpu::Specialization counting{{shader::SPEC_SLICED, variant.sliced ? 1U : 0U}};
    gpu::Specialization scattering = counting;
    scattering.emplace_back(shader::SPEC_CULLED, variant.culled ? 1U : 0U);
    if (side_by_side(variant, profile))
        return {{"4a_count_slots.comp", counting},
                {"4b_sum_sheets.comp", {}},
                {"4b_place_sheets.comp", {}},
                {"4c_scatter_slots.comp", scattering}};
    return {{"4a_count_sheets.comp", counting},
            {"4b_scan_sheets.comp", {{shader::SPEC_TILES, variant.tiles ? 1U : 0U}}},
            {"4c_scatter_splats.comp", scattering}};
}

void sort_sheets(gpu::Commands& commands, const DrawVariant& variant, const shader::FrameParams& params,
                 std::uint32_t segments) {
    const std::vector<SortStep> steps = sort_sheets_steps(variant, commands.profile());
    const auto dispatch = [&](std::size_t step, std::uint32_t number, gpu::Groups groups) {
        commands.dispatch(steps[step].shader, steps[step].constants, number, groups);
        commands.barrier();
    };
    if (side_by_side(variant, commands.profile())) {
        dispatch(0, 0, commands.groups_for(params.slot_count, 64));
        dispatch(1, 0, commands.groups_for(params.sheet_count, 1));
        dispatch(2, 0, {1});
        dispatch(3, 0, {shader::SORT_BLOCKS});
        return;
    }
    const auto over_blocks = [&](std::size_t step) {
        for (std::uint32_t segment = 0; segment < segments; ++segment)
            dispatch(step, segment, {shader::SORT_BLOCKS / 64});
    };
    over_blocks(0);
    dispatch(1, 0, {1});
    over_blocks(2);
}

}  // namespace edgesplat::passes
