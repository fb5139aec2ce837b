// RendererState: blocks that a picture can do without, since what lies in front of them is opaque.
#include <algorithm>
#include <cmath>

#include "engine/frame_parts.h"
#include "engine/gpu/read_back.h"
#include "engine/renderer_state.h"

namespace edgesplat {
namespace {

/// Tiles x0, y0, x1, y1, half open, that a block's kernels may show in; nothing where they may reach the eye's plane.
std::optional<glm::ivec4> tiles_of_block(const VolumeGeometry& geometry, const Camera& camera, const glm::ivec2& size,
                                         const CollectionBlock& block, double reach) {
    const CameraFrame view = camera_frame(camera);
    const glm::dvec2 tan_half(view.tan_half_y * size.x / size.y, view.tan_half_y);
    const glm::dvec3 from = glm::dvec3(block.core_low) - reach;
    const glm::dvec3 to = glm::dvec3(block.core_low + block.core_size - 1) + reach;
    glm::dvec2 low(size), high(0);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::bvec3 far((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
        const glm::dvec3 v = geometry.to_world(glm::mix(from, to, far)) - view.eye;
        const double depth = glm::dot(view.forward, v);
        if (!(depth > 0)) return std::nullopt;
        const glm::dvec2 slope(glm::dot(view.right, v) / depth, -glm::dot(view.up, v) / depth);
        const glm::dvec2 pixel = (slope / tan_half * 0.5 + 0.5) * glm::dvec2(size);
        low = glm::min(low, pixel - 1.0);
        high = glm::max(high, pixel + 1.0);
    }
    constexpr double kTile = shader::TILE;
    low = glm::clamp(glm::floor(low), glm::dvec2(0), glm::dvec2(size));
    high = glm::clamp(glm::ceil(high), low, glm::dvec2(size));
    return glm::ivec4(glm::floor(low / kTile), glm::ceil(high / kTile));
}

}  // namespace

bool RendererState::may_hide_blocks(const FrameRequest& request) const {
    const Settings drawn = drawn_settings(request);
    // Parts, lights and optical depth need what cannot be seen; several samples are as many pictures.
    return exchange == nullptr && shadow_lights(request.scene).empty() && !request.outputs.tau &&
           request.scene.effects.samples == 1 && drawn.saturation < 1 && drawn.sheet_format == SheetFormat::Tiles;
}

void RendererState::sort_by_depth(const FrameRequest& request, std::vector<std::size_t>& blocks) const {
    const double thickness = sheet_thickness(volume->geometry, request.camera, drawn_settings(request));
    std::ranges::stable_sort(blocks, {}, [&](std::size_t i) {
        return sheets_of_block(volume->geometry, request.camera, thickness, footprint_resources.farthest_reach,
                               residence->blocks[i])
            .x;
    });
}

void RendererState::leave_hidden_blocks(const FrameRequest& request, std::vector<std::size_t>& missing,
                                        std::size_t first) {
    if (volume_resources.splat_count == 0 || first + 1 >= missing.size()) return;
    const Settings drawn = drawn_settings(request);
    const double reach = footprint_resources.farthest_reach;
    const auto& geometry = volume->geometry;
    // Whatever is missing lies behind these sheets, so that pixels which they close are closed in the whole picture.
    const double thickness = sheet_thickness(geometry, request.camera, drawn);
    const glm::ivec2 sheets =
        sheets_of_block(geometry, request.camera, thickness, reach, residence->blocks[missing[first]]);
    bound_held_blocks();
    plan = plan_picture(request.scene, request.camera, drawn, request.size, shader::PAYLOAD_COLOR);
    // A little more than a pixel needs to be closed, for what the box of the splats does to rounding.
    plan.params.saturation += 0.2F * (1 - plan.params.saturation);
    plan.refined = false;
    provide_targets(plan);
    const Chunks chunks = sort_frame(commands, plan, targets, {{}, glm::ivec2(0, sheets.x)});
    provide_chunks(chunks);
    draw_frame(commands, plan, targets, static_cast<std::uint32_t>(chunks.parts.size()),
               {.rounds = device.is_software(), .part = true});
    const glm::ivec2 tiles = plan.params.tiles, size = request.size;
    const auto closed =
        gpu::read_back<std::uint32_t>(device, commands, targets.tile_closed, 0,
                                      static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y));
    release_for_collection();

    constexpr int kTile = static_cast<int>(shader::TILE);
    const auto is_closed = [&](int x, int y) {
        const glm::ivec2 pixels = glm::min(glm::ivec2(kTile), size - kTile * glm::ivec2(x, y));
        return closed[static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles.x) + static_cast<std::size_t>(x)] ==
               static_cast<std::uint32_t>(pixels.x * pixels.y);
    };
    const auto is_hidden = [&](std::size_t i) {
        const auto box = tiles_of_block(geometry, request.camera, size, residence->blocks[i], reach);
        if (!box) return false;
        for (int y = box->y; y < box->w; ++y)
            for (int x = box->x; x < box->z; ++x)
                if (!is_closed(x, y)) return false;
        return true;
    };
    const auto behind = missing.begin() + static_cast<std::ptrdiff_t>(first);
    missing.erase(std::remove_if(behind, missing.end(), is_hidden), missing.end());
}

}  // namespace edgesplat
