#include "engine/passes/1_estimate_edges.h"

namespace edgesplat::passes {

gpu::Pass mark_buried(const glm::ivec3& dims, std::uint32_t iso_count, const ClipCount& clip) {
    const glm::uvec3 n(dims);
    const std::uint32_t lines[3] = {n.y * n.z, n.x * n.z, n.x * n.y};
    gpu::Pass pass{"1a_mark_buried", {}};
    for (std::uint32_t axis = 0; axis < 3; ++axis)
        pass.dispatches.push_back({"1a_mark_buried.comp",
                                   {{shader::SPEC_AXIS, axis},
                                    {shader::SPEC_ISO_COUNT, iso_count},
                                    {shader::SPEC_CLIP_KEEP, clip.keep},
                                    {shader::SPEC_CLIP_REMOVE, clip.remove}},
                                   gpu::Invocations{lines[axis]}});
    return pass;
}

gpu::Pass estimate_edges(const EdgeRegion& region, const EstimateEdges& in) {
    const glm::ivec3 low = glm::max(region.core_low - shader::ESTIMATE_MARGIN, 0);
    const glm::ivec3 high = glm::min(region.core_low + region.core_size + shader::ESTIMATE_MARGIN, region.dims);
    const glm::uvec3 bricks = (glm::uvec3(high - low) + 7U) / 8U;
    const std::uint64_t count = region.bricks > 0 ? region.bricks : std::uint64_t{bricks.x} * bricks.y * bricks.z;
    return {"1_estimate_edges",
            {{"1b_estimate_edges.comp",
              {{shader::SPEC_ESTIMATOR, static_cast<std::uint32_t>(in.estimator)},
               {shader::SPEC_BURIED, in.skip_buried ? 1 : 0},
               {shader::SPEC_ISO_COUNT, in.iso_count},
               {shader::SPEC_SURFACES, in.surfaces ? 1 : 0}},
              gpu::Workgroups{count}}}};
}

}  // namespace edgesplat::passes
