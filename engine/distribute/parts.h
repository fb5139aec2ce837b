// Divides a picture's sheets between parts, and corrects the pixels of a part that saturate only together with the
// parts in front.
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

/// The part's sheets, half open and consecutive. All parts have about the same number of pairs; `pairs`: per sheet.
/// Together the parts cover all sheets. With fewer sheets than parts some parts have none.
glm::uvec2 sheets_of_part(std::span<const std::uint32_t> pairs, const SheetPart& part);

/// Sheets that kernels of a block's voxels may reach, numbered from the eye on, half open. `thickness`: of a sheet, mm.
/// `reach`: of the kernels, voxels.
glm::ivec2 sheets_of_block(const VolumeGeometry& geometry, const Camera& camera, double thickness, double reach,
                           const CollectionBlock& block);

/// The part's sheets if splats are collected block by block: numbered from the eye on, half open. All parts have about
/// the same number of the blocks' voxels, and a part needs only blocks that reach its sheets. Together the parts cover
/// all possible sheets.
glm::ivec2 slab_of_part(const VolumeGeometry& geometry, const Camera& camera, double thickness,
                        std::span<const CollectionBlock> blocks, const SheetPart& part);

/// Which sheets of a picture a renderer draws.
struct Division {
    SheetPart part;
    std::optional<glm::ivec2> slab;  ///< sheets numbered from the eye on; nullopt: divided by pairs
    bool continues = false;          ///< continues behind sheets that are drawn already

    /// The sheets, numbered from the picture's first sheet `base` on. `pairs`: per sheet.
    glm::uvec2 sheets(std::span<const std::uint32_t> pairs, int base) const;
};

/// Pixels of a part that must be drawn again because of the parts in front. Behind saturated pixels nothing is added.
/// Pixels that saturate within the part are drawn again with the opacity in front, so that they stop at the right
/// sheet.
class PixelsBehind {
  public:
    /// `in_front`: transmittance of the parts in front. `part`: this part as drawn without them; pixels that they
    /// saturate are cleared. `pixels`: gets the start of the second drawing: saturated, except for the pixels to draw
    /// again, which get the opacity in front.
    PixelsBehind(std::span<const float> in_front, float saturation, std::span<glm::vec4> part,
                 std::span<glm::vec4> pixels);

    bool any() const { return !again_.empty(); }
    /// Number of saturated pixels of each tile, row by row, out of the `drawn` ones.
    std::vector<std::uint32_t> closed_pixels(const glm::ivec2& size, const glm::ivec2& tiles,
                                             std::span<const std::uint32_t> drawn) const;
    /// Copies the pixels drawn again into the part, with the opacity in front removed.
    void take(std::span<const float> in_front, std::span<const glm::vec4> pixels, std::span<glm::vec4> part) const;

  private:
    std::vector<std::size_t> again_;
};

}  // namespace edgesplat
