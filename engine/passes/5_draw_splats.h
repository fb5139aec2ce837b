// Sorted splats -> one sheet group: a layer per sheet, (sum tau * colour, sum tau).
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"
#include "engine/scene/scene.h"
#include "engine/scene/settings.h"

namespace edgesplat::passes {

/// Pipeline variant of the draw: every member is a specialization constant.
struct DrawVariant {
    FootprintMode footprints;
    WarpFamily warp;
    bool narrow = false;        ///< kernels are the narrow ones
    std::uint32_t lights = 0;   ///< how many
    std::uint32_t payload = 0;  ///< shader::PAYLOAD_*
    bool sliced = false;        ///< kernels are cut at the sheets' planes
    bool occlusion = false;     ///< ambient light is what 2b_occlude_ambient left of it
    std::uint32_t shadows = 0;  ///< lights with shadows
    std::uint32_t nodes = 5;    ///< quadrature nodes of a piece of a footprint: 4, 5 or 10
    bool transfer = false;      ///< colour and extinction by a transfer function
    bool response = false;      ///< materials answer to light each in its own way
    bool gloss = false;         ///< some have highlights
    bool lit_edges = false;     ///< splats without an edge count as without normal
    bool silhouette = false;
    bool fog = false;
    ClipCount clip{};        ///< kernels are cut at planes
    bool opaque = false;     ///< of a ray's two pieces in a cut kernel the longer counts
    bool creases = false;    ///< planes beside faces cut kernels, too
    bool traced = false;     ///< where no quadric fits, rays find the faces
    bool antialias = false;  ///< no footprint is narrower than a pixel
    bool outlines = false;   ///< pixels keep where outlines pass them
    bool tiles = false;      ///< sheets are summed tile by tile, not in layers
    bool culled = false;     ///< splats are gone through in batches, those of bricks in view
};

/// Specialization of 5b_draw_splats.vert and .frag, and of 5_draw_tiles.comp.
gpu::Specialization draw_constants(const DrawVariant& variant);

struct DrawSplats {
    DrawVariant variant;
    const gpu::GpuImage& sheets;  ///< (sheets_per_group, height, width) colour layers
    const gpu::GpuImage& depth;   ///< likewise, D16: 0 closes a pixel that is opaque already
    const gpu::Buffer& indices;   ///< quad_indices()
    const gpu::Buffer& draws;     ///< DrawCommand per group
};

/// Index list of shader::QUADS_PER_INSTANCE quads, two triangles each.
std::vector<std::uint32_t> quad_indices();
inline constexpr std::uint32_t kQuadIndices = 6 * shader::QUADS_PER_INSTANCE;

/// Clears the group's pixels, closes the opaque ones, then adds the group's splats.
void draw_splats(gpu::Commands& commands, const DrawSplats& in, std::uint32_t group);

}  // namespace edgesplat::passes
