#include "engine/passes/4_sort_sheets.h"

namespace edgesplat::passes {

gpu::Pass sort_sheets(const gpu::DeviceProfile& profile, const DrawVariant& variant, const shader::FrameParams& params,
                      std::uint32_t segments) {
    const gpu::Specialization counting{{shader::SPEC_SLICED, variant.sliced ? 1U : 0U}};
    gpu::Specialization scattering = counting;
    scattering.emplace_back(shader::SPEC_CULLED, variant.culled ? 1U : 0U);
    gpu::Pass pass{"4_sort_sheets", {}};
    if (profile.side_by_side && variant.tiles) {
        pass.dispatches = {{"4a_count_slots.comp", counting, gpu::Invocations{params.slot_count}},
                           {"4b_sum_sheets.comp", {}, gpu::Workgroups{params.sheet_count}},
                           {"4b_place_sheets.comp", {}, gpu::Columns{1}},
                           {"4c_scatter_slots.comp", scattering, gpu::Columns{shader::SORT_BLOCKS}}};
        return pass;
    }
    const auto over_blocks = [&](const char* shader, const gpu::Specialization& constants) {
        for (std::uint32_t segment = 0; segment < segments; ++segment)
            pass.dispatches.push_back({shader, constants, gpu::Grid{{shader::SORT_BLOCKS, 1, 1}}, segment});
    };
    over_blocks("4a_count_sheets.comp", counting);
    pass.dispatches.push_back(
        {"4b_scan_sheets.comp", {{shader::SPEC_TILES, variant.tiles ? 1U : 0U}}, gpu::Columns{1}});
    over_blocks("4c_scatter_splats.comp", scattering);
    return pass;
}

}  // namespace edgesplat::passes
