#include "engine/passes/4_sort_sheets.h"

namespace edgesplat::passes {

void sort_sheets(gpu::Commands& commands, bool sliced) {
    const gpu::Specialization constants{{shader::SPEC_SLICED, sliced ? 1U : 0U}};
    commands.dispatch("4a_count_sheets.comp", constants, 0, {shader::SORT_BLOCKS / 64});
    commands.barrier();
    commands.dispatch("4b_scan_sheets.comp", {}, 0, {1});
    commands.barrier();
    commands.dispatch("4c_scatter_splats.comp", constants, 0, {shader::SORT_BLOCKS / 64});
    commands.barrier();
}

}  // namespace edgesplat::passes
