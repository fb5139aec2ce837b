// A picture whose sheets are drawn in parts: which sheets are whose, and how a part that has something in front of it
// closes its pixels where the whole picture would.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/distribute/part_exchange.h"
#include "engine/scene/camera.h"
#include "engine/store/volume_store.h"

namespace edgesplat {

/// The part's sheets, half open: consecutive, with about as many of all `pairs` (per sheet) as any other part's.
/// Together the parts are all sheets; where there are fewer sheets than parts, some have none.
glm::uvec2 sheets_of_part(std::span<const std::uint32_t> pairs, const SheetPart& part);

/// Sheets numbered from the eye on, half open, in which kernels of a block's voxels may lie. `thickness`: of a sheet,
/// mm; `reach`: of the kernels, voxels.
glm::ivec2 sheets_of_block(const VolumeGeometry& geometry, const Camera& camera, double thickness, double reach,
                           const CollectionBlock& block);

/// The part's sheets where splats are collected block by block, so that a part needs no block but those that reach into
/// its sheets: numbered from the eye on, half open, with about as many of the blocks' voxels as any other part's.
/// Together the parts are all sheets there can be.
glm::ivec2 slab_of_part(const VolumeGeometry& geometry, const Camera& camera, double thickness,
                        std::span<const CollectionBlock> blocks, const SheetPart& part);

/// Which sheets of a picture a renderer draws.
struct Division {
    SheetPart part;
    std::optional<glm::ivec2> slab;  ///< numbered from the eye on; absent: by pairs
    bool goes_on = false;            ///< behind what is drawn already

    /// As a picture counts its sheets: from `base` on, with `pairs` in each.
    glm::uvec2 sheets(std::span<const std::uint32_t> pairs, int base) const;
};

/// What is in front of a part decides over its pixels: behind closed ones nothing is added, and those that close within
/// the part must be drawn anew, so that they take nothing after the sheet that closes them.
class PixelsBehind {
  public:
    /// `in_front`: what the parts in front let through. `part`: this part as it was drawn with nothing in front; where
    /// the parts in front are closed it becomes empty. `pixels` is what it is to be drawn over again: closed but for
    /// those that must be.
    PixelsBehind(std::span<const float> in_front, float saturation, std::span<glm::vec4> part,
                 std::span<glm::vec4> pixels);

    bool any() const { return !again_.empty(); }
    /// Of each tile, how many of the pixels that are `drawn` are closed; row by row.
    std::vector<std::uint32_t> closed_pixels(const glm::ivec2& size, const glm::ivec2& tiles,
                                             std::span<const std::uint32_t> drawn) const;
    /// Takes what was drawn again over into the part, as if nothing were in front.
    void take(std::span<const float> in_front, std::span<const glm::vec4> pixels, std::span<glm::vec4> part) const;

  private:
    std::vector<std::size_t> again_;
};

}  // namespace edgesplat
