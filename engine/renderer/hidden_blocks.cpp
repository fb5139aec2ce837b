// RendererState: blocks that a picture can do without, since what lies in front of them is opaque.
#include <algorithm>

#include "engine/compositors/tiles/hiding.h"
#include "engine/distribute/parts.h"
#include "engine/gpu/read_back.h"
#include "engine/renderer/state.h"

namespace edgesplat {

bool RendererState::may_hide_blocks(const FrameRequest& request) const {
    const Settings drawn = drawn_settings(request);
    // Parts, lights and optical depth need what cannot be seen; several samples are as many pictures.
    return exchange == nullptr && shadow_lights(request.scene).empty() && !request.outputs.tau &&
           request.scene.effects.samples == 1 && drawn.saturation < 1 && drawn.sheet_format == SheetFormat::Tiles;
}

void RendererState::sort_by_depth(const FrameRequest& request, std::vector<std::size_t>& blocks) const {
    const Settings drawn = drawn_settings(request);
    const double thickness = sheet_thickness(volume->geometry, request.camera, drawn), reach = kernel_reach(drawn);
    std::ranges::stable_sort(blocks, {}, [&](std::size_t i) {
        return sheets_of_block(volume->geometry, request.camera, thickness, reach, residence->blocks[i]).x;
    });
}

void RendererState::leave_hidden_blocks(const FrameRequest& request, std::vector<std::size_t>& missing,
                                        std::size_t first) {
    if (volume_resources.splat_count == 0 || first + 1 >= missing.size()) return;
    const Settings drawn = drawn_settings(request);
    const double reach = kernel_reach(drawn);
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
    const Chunks chunks = sort_frame(commands, plan, targets, {.slab = glm::ivec2(0, sheets.x)});
    provide_chunks(chunks);
    draw_tiles(commands, plan, targets, static_cast<std::uint32_t>(chunks.parts.size()),
               {.profile = &device.profile(), .part = true});
    const OpenTiles open(plan,
                         gpu::read_back<std::uint32_t>(device, commands, targets.tile_closed, 0, tile_count(plan)));
    release_for_collection();

    const auto is_hidden = [&](std::size_t i) {
        const CollectionBlock& block = residence->blocks[i];
        return !open.may_show({block.core_low, block.core_low + block.core_size - 1});
    };
    const auto behind = missing.begin() + static_cast<std::ptrdiff_t>(first);
    missing.erase(std::remove_if(behind, missing.end(), is_hidden), missing.end());
}

}  // namespace edgesplat
