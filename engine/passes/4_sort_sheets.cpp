#include "engine/passes/4_sort_sheets.h"

namespace edgesplat::passes {

gpu::Specialization scan_constants(bool tiles) {
    return {{shader::SPEC_TILES, tiles ? 1U : 0U}};
}

void sort_sheets(gpu::Commands& commands, bool sliced, bool tiles, std::uint32_t segments) {
    const gpu::Specialization constants{{shader::SPEC_SLICED, sliced ? 1U : 0U}};
    const auto over_blocks = [&](const char* shader) {
        for (std::uint32_t segment = 0; segment < segments; ++segment) {
            commands.dispatch(shader, constants, segment, {shader::SORT_BLOCKS / 64});
            commands.barrier();
        }
    };
    over_blocks("4a_count_sheets.comp");
    commands.dispatch("4b_scan_sheets.comp", scan_constants(tiles), 0, {1});
    commands.barrier();
    over_blocks("4c_scatter_splats.comp");
}

}  // namespace edgesplat::passes
