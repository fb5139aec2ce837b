#include "engine/passes/2_collect_splats.h"

#include "engine/culling/brick_runs.h"

namespace edgesplat::passes {
namespace {

gpu::Pass collect(const CollectSplats& in, bool write) {
    const std::uint64_t runs = in.bricks > 0 ? std::uint64_t{in.bricks} * shader::BRICK : collect_runs(in.core_size);
    return {"2_collect_splats",
            {{"2_collect_splats.comp",
              {{shader::SPEC_ISO_COUNT, in.iso_count},
               {shader::SPEC_EDGES, in.edges ? 1 : 0},
               {shader::SPEC_BURIED, in.buried ? 1 : 0},
               {shader::SPEC_CLIP_KEEP, in.clip.keep},
               {shader::SPEC_CLIP_REMOVE, in.clip.remove},
               {shader::SPEC_TRANSFER, in.transfer ? 1 : 0},
               {shader::SPEC_LABELS, in.labels},
               {shader::SPEC_SURFACES, in.surfaces ? 1 : 0}},
              gpu::Invocations{runs},
              write ? 1U : 0U}}};
}

}  // namespace

std::uint64_t collect_runs(const glm::ivec3& core_size) {
    return BrickRuns(core_size).count();
}

gpu::Pass count_splats(const CollectSplats& in) {
    return collect(in, false);
}

gpu::Pass write_splats(const CollectSplats& in) {
    return collect(in, true);
}

gpu::Pass finish_splats(const CollectSplats& in, std::uint64_t count) {
    if (!in.edges || count == 0) return {"2_collect_splats", {}};
    return {"2_collect_splats",
            {{"2a_finish_splats.comp",
              {{shader::SPEC_ISO_COUNT, in.iso_count},
               {shader::SPEC_ESTIMATOR, static_cast<std::uint32_t>(in.estimator)},
               {shader::SPEC_FACES, in.faces ? 1 : 0},
               {shader::SPEC_SURFACES, in.surfaces ? 1 : 0},
               {shader::SPEC_TWO_VALUES, in.two_values ? 1 : 0}},
              gpu::Invocations{count}}}};
}

}  // namespace edgesplat::passes
