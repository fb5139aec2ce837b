// Sorted splats -> one sheet group: a layer per sheet, (sum tau * colour, sum tau).
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"
#include "engine/scene/scene.h"
#include "engine/scene/settings.h"
#include "footprints/face.h"

namespace edgesplat::passes {

/// Pipeline variant of the draw: every member becomes specialization constants.
struct DrawVariant {
    FootprintMode footprints;
    WarpFamily warp;
    bool narrow = false;              ///< narrow kernels
    std::uint32_t payload = 0;        ///< shader::PAYLOAD_*
    bool sliced = false;              ///< kernels are cut at the sheets' planes
    std::uint32_t shadows = 0;        ///< number of lights with shadows
    std::uint32_t nodes = kFewNodes;  ///< quadrature nodes per piece of a footprint: 4, 6 or 10
    gpu::Specialization shading;      ///< what colours depend on, by constants that nothing else depends on
    ClipCount clip{};                 ///< kernels are cut at clip planes
    bool opaque = false;              ///< only the longer of a ray's two pieces in a cut kernel counts
    bool creases = false;             ///< kernels are also cut at creases: planes beside faces
    bool surfaces = false;            ///< surface splats, drawn by 5_draw_surfaces
    bool mixed = false;               ///< surface splats draw opaque matter, kernels translucent matter in front of it
    bool several = false;             ///< with `mixed`: the surfaces are those of several volumes
    bool rim = false;                 ///< along a rim, kernels of one volume give way to those of another
    bool inner = false;               ///< surfaces of one volume continue those of another
    bool together = false;            ///< kernels of several volumes are drawn as one list
    std::uint32_t iso_count = 1;      ///< number of iso-values; only with surface splats
    bool begins = false;     ///< with surface splats: rays may enter the volume, or what clip planes keep, in matter
    bool traced = false;     ///< rays find the faces of flagged splats, whose quadric does not fit
    bool antialias = false;  ///< footprints are at least a pixel wide
    bool outlines = false;   ///< stores where outlines cross each pixel
    bool tiles = false;      ///< sheets are summed tile by tile, not in layers
    bool culled = false;     ///< splats are processed in batches of bricks in view
};

/// Specialization of 5b_draw_splats.vert and .frag, and of 5_draw_tiles.comp.
gpu::Specialization draw_constants(const DrawVariant& variant);

struct DrawSplats {
    DrawVariant variant;
    const gpu::GpuImage& sheets;  ///< (sheets_per_group, height, width) colour layers
    const gpu::GpuImage& depth;   ///< same size, D16: 0 rejects fragments of saturated pixels
    const gpu::Buffer& indices;   ///< quad_indices()
    const gpu::Buffer& draws;     ///< a DrawCommand per group
};

/// Index list of shader::QUADS_PER_INSTANCE quads, two triangles each.
std::vector<std::uint32_t> quad_indices();
inline constexpr std::uint32_t kQuadIndices = 6 * shader::QUADS_PER_INSTANCE;

/// Clears the group's pixels, masks the saturated ones, then adds the group's splats.
void draw_splats(gpu::Commands& commands, const DrawSplats& in, std::uint32_t group);

}  // namespace edgesplat::passes
