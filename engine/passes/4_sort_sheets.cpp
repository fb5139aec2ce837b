#include "engine/passes/4_sort_sheets.h"

namespace edgesplat::passes {

gpu::Specialization count_constants(const DrawVariant& variant) {
    return {{shader::SPEC_SLICED, variant.sliced ? 1U : 0U}};
}

gpu::Specialization scan_constants(const DrawVariant& variant) {
    return {{shader::SPEC_TILES, variant.tiles ? 1U : 0U}};
}

gpu::Specialization scatter_constants(const DrawVariant& variant) {
    return {{shader::SPEC_SLICED, variant.sliced ? 1U : 0U}, {shader::SPEC_CULLED, variant.culled ? 1U : 0U}};
}

bool sorts_side_by_side(const DrawVariant& variant, const gpu::DeviceProfile& profile) {
    return profile.side_by_side && variant.tiles;
}

void sort_sheets(gpu::Commands& commands, const DrawVariant& variant, const shader::FrameParams& params,
                 std::uint32_t segments) {
    const auto dispatch = [&](const char* shader, const gpu::Specialization& constants, std::uint32_t number,
                              gpu::Groups groups) {
        commands.dispatch(shader, constants, number, groups);
        commands.barrier();
    };
    if (sorts_side_by_side(variant, commands.profile())) {
        dispatch("4a_count_slots.comp", count_constants(variant), 0, gpu::groups_for(params.slot_count, 64));
        dispatch("4b_sum_sheets.comp", {}, 0, gpu::groups_for(params.sheet_count, 1));
        dispatch("4b_place_sheets.comp", {}, 0, {1});
        dispatch("4c_scatter_slots.comp", scatter_constants(variant), 0, {shader::SORT_BLOCKS});
        return;
    }
    const auto over_blocks = [&](const char* shader, const gpu::Specialization& constants) {
        for (std::uint32_t segment = 0; segment < segments; ++segment)
            dispatch(shader, constants, segment, {shader::SORT_BLOCKS / 64});
    };
    over_blocks("4a_count_sheets.comp", count_constants(variant));
    dispatch("4b_scan_sheets.comp", scan_constants(variant), 0, {1});
    over_blocks("4c_scatter_splats.comp", scatter_constants(variant));
}

}  // namespace edgesplat::passes
