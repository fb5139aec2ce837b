// Sorted splats -> one sheet group: a layer per sheet, (sum tau * colour, sum tau).
#pragma once

#include "engine/gpu/commands.h"
#include "engine/scene/scene.h"
#include "engine/scene/settings.h"

namespace edgesplat::passes {

/// Pipeline variant of the draw: every member is a specialization constant.
struct DrawVariant {
    FootprintMode footprints;
    WarpFamily warp;
    Light::Kind light;
    std::uint32_t payload = 0;  ///< shader::PAYLOAD_*
    bool sliced = false;        ///< kernels are cut at the sheets' planes
    bool curved = false;        ///< edges are spheres of their curvature
    bool weighted = false;      ///< kernels are normalised
    std::uint32_t nodes = 10;   ///< quadrature nodes of a piece of a footprint: 4, 10 or 16
};

struct DrawSplats {
    shader::Address frame;
    DrawVariant variant;
    const gpu::GpuImage& sheets;  ///< (sheets_per_group, height, width) colour layers
    const gpu::GpuImage& depth;   ///< likewise, D16: 0 closes a pixel that is opaque already
    const gpu::Buffer& indices;   ///< quad_indices()
    const gpu::Buffer& draws;     ///< DrawCommand per group
};

/// Index list of shader::QUADS_PER_INSTANCE quads, two triangles each.
std::vector<std::uint32_t> quad_indices();

/// Clears the group's pixels, closes the opaque ones, then adds the group's splats.
void draw_splats(gpu::Commands& commands, const DrawSplats& in, std::uint32_t group);

}  // namespace edgesplat::passes
