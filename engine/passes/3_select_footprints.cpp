#include "engine/passes/3_select_footprints.h"

namespace edgesplat::passes {

gpu::Pass select_footprints(std::uint64_t slots, const DrawVariant& variant) {
    return {"3_select_footprints",
            {{"3_select_footprints.comp",
              {{shader::SPEC_FOOTPRINTS, static_cast<std::uint32_t>(variant.footprints)},
               {shader::SPEC_WARP, static_cast<std::uint32_t>(variant.warp)},
               {shader::SPEC_NARROW, variant.narrow ? 1U : 0U},
               {shader::SPEC_SLICED, variant.sliced ? 1U : 0U},
               {shader::SPEC_CLIP_KEEP, variant.clip.keep},
               {shader::SPEC_CLIP_REMOVE, variant.clip.remove},
               {shader::SPEC_ANTIALIAS, variant.antialias ? 1U : 0U},
               {shader::SPEC_CREASES, variant.creases ? 1U : 0U},
               {shader::SPEC_TRACED, variant.traced ? 1U : 0U},
               {shader::SPEC_SURFACES, variant.surfaces ? 1U : 0U},
               {shader::SPEC_TILES, variant.tiles ? 1U : 0U},
               {shader::SPEC_CULLED, variant.culled ? 1U : 0U}},
              gpu::Invocations{slots}}}};
}

}  // namespace edgesplat::passes
