// The ray caster's frame: what it is given, what it keeps, and the two passes it consists of.
#pragma once

#include <array>

#include "engine/passes/raycast.h"
#include "engine/plan/plan.h"
#include "engine/plan/resources.h"
#include "engine/renderer.h"
#include "shaders/shared/raycast_params.h"

namespace edgesplat {

/// One picture by ray casting.
struct RaycastPlan {
    passes::RaycastVariant variant;
    std::vector<shader::TransferRow> transfer;  ///< TRANSFER_ROWS + 1; empty without a transfer function
    glm::ivec2 size{0};
    shader::RaycastBlock block{};  ///< without addresses
};

/// `scene`, `camera` and both settings are valid; `collection` is plan_collection()'s for them.
RaycastPlan plan_raycast(const Volume& volume, const Scene& scene, const Camera& camera, const Settings& settings,
                         const RaycastSettings& raycast, const CollectionPlan& collection, const glm::ivec2& size);

/// What the ray caster keeps between pictures of one volume; nothing of it exists before the first.
class RaycastResources {
  public:
    RaycastResources(const gpu::Device& device, const gpu::Pipelines& pipelines, gpu::Commands& commands);

    /// Buffers of the plan's size, and its numbers in them. `volume` holds the uploaded volume, and the spline's
    /// coefficients if the plan's filter is cubic.
    void prepare(const gpu::Device& device, const RaycastPlan& plan, const VolumeImages& volume);

    /// Finds the transparent bricks and waits, if the plan skips them and its materials are others than last time.
    /// Whether that was so.
    bool classify(const gpu::Device& device, gpu::Commands& commands, const RaycastPlan& plan);

    /// Casts the rays and waits.
    void cast(gpu::Commands& commands, const RaycastPlan& plan) const;

    /// (height, width) vec4 of the last run.
    std::span<const float> pixels() const;

    /// Whether the last picture was cast through the spline.
    bool takes_coefficients() const { return takes_coefficients_; }

  private:
    Bindings bindings_;  ///< the common layout, with the bricks in it
    /// Transparent bricks of a filter's field.
    struct Bricks {
        gpu::GpuImage image;             ///< (z, y, x) r8ui: BIND_BRICKS
        shader::SceneParams made_for{};  ///< iso_count 0, and no transfer function: for nothing yet
        std::vector<shader::TransferRow> made_for_transfer;
    };
    std::array<Bricks, kRaycastFilterNames.size()> bricks_;  ///< an image where that filter was asked for
    gpu::Buffer transfer_;                                   ///< TransferRow, mapped; with a transfer function
    gpu::Buffer block_;                                      ///< RaycastBlock, mapped
    gpu::Buffer output_;                                     ///< (height, width) vec4, mapped
    glm::ivec2 size_{0};
    bool takes_coefficients_ = false;
};

}  // namespace edgesplat
