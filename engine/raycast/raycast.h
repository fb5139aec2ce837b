// The ray caster's frame: its plan, its resources, and its two passes.
#pragma once

#include <array>

#include "engine/passes/raycast.h"
#include "engine/plan/plan.h"
#include "engine/plan/resources.h"
#include "engine/renderer.h"
#include "shaders/shared/raycast_params.h"

namespace edgesplat {

/// Plan of one ray-cast picture.
struct RaycastPlan {
    passes::RaycastVariant variant;
    std::vector<shader::TransferRow> transfer;  ///< TRANSFER_ROWS + 1; empty without a transfer function
    std::vector<glm::vec3> label_colors;        ///< FramePlan::label_colors
    glm::ivec2 size{0};
    shader::RaycastBlock block{};  ///< addresses unset
};

/// `scene`, `camera` and both settings must be valid; `collection` is the result of plan_collection() for them.
RaycastPlan plan_raycast(const Volume& volume, const Scene& scene, const Camera& camera, const Settings& settings,
                         const RaycastSettings& raycast, const CollectionPlan& collection, const glm::ivec2& size);

/// Resources that the ray caster keeps between pictures of one volume; created with the first picture.
class RaycastResources {
  public:
    RaycastResources(const gpu::Device& device, const gpu::Pipelines& pipelines, gpu::Commands& commands);

    /// Allocates buffers of the plan's size and writes its parameters. `volume` must have the uploaded samples, and the
    /// spline coefficients if the plan's filter is cubic.
    void prepare(const gpu::Device& device, const RaycastPlan& plan, const VolumeImages& volume);

    /// Classifies transparent bricks and waits, if the plan skips them and its materials changed. Returns whether it
    /// ran.
    bool classify(const gpu::Device& device, gpu::Commands& commands, const RaycastPlan& plan);

    /// Casts the rays and waits.
    void cast(gpu::Commands& commands, const RaycastPlan& plan) const;

    /// Pixels of the last run: (height, width) vec4.
    std::span<const float> pixels() const;

    /// Whether the last picture used the spline coefficients.
    bool takes_coefficients() const { return takes_coefficients_; }

  private:
    Bindings bindings_;  ///< the common layout, including the bricks
    /// Classified bricks for one filter.
    struct Bricks {
        gpu::GpuImage image;             ///< (z, y, x) r8ui: BIND_BRICKS
        shader::SceneParams made_for{};  ///< scene of the classification; iso_count 0 and no transfer: none yet
        std::vector<shader::TransferRow> made_for_transfer;
    };
    std::array<Bricks, kRaycastFilterNames.size()> bricks_;  ///< by filter; an image once the filter was used
    gpu::Buffer transfer_;                                   ///< TransferRow, mapped; only with a transfer function
    gpu::Buffer label_colors_;                               ///< (labels) vec3, mapped; only with labels
    gpu::Buffer block_;                                      ///< RaycastBlock, mapped
    gpu::Buffer output_;                                     ///< (height, width) vec4, mapped
    glm::ivec2 size_{0};
    bool takes_coefficients_ = false;
};

}  // namespace edgesplat
