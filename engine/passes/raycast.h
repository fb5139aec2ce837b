// Ray casting of the volume, the reference that splatting is compared with.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/scene/scene.h"

namespace edgesplat::passes {

/// Bricks along each axis of a volume.
glm::ivec3 brick_count(const glm::ivec3& dims);

/// Pipeline variant of the ray caster: every member is a specialization constant.
struct RaycastVariant {
    std::uint32_t light = 1;  ///< light_code()
    std::uint32_t iso_count = 1;
    bool skip_empty = true;    ///< transparent bricks are skipped
    std::uint32_t filter = 0;  ///< RaycastFilter
    bool no_data = false;      ///< rays meet samples without data where the smallest value would be drawn
    std::uint32_t labels = 0;  ///< SPEC_LABELS: every label has its own colour
    bool transfer = false;     ///< colour and extinction are from a transfer function, else from the material
};

/// Volume -> distance of every brick to the nearest one that is not transparent in the variant's field. The ray
/// caster's descriptor set must be bound.
gpu::Pass classify_bricks(const RaycastVariant& variant, const glm::ivec3& dims);

/// Writes the pixels at FrameParams::output_pixels of the ray caster's block: (height, width) vec4, linear light.
gpu::Pass cast_rays(const RaycastVariant& variant, const glm::ivec2& size);

}  // namespace edgesplat::passes
