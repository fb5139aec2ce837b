// DeviceChoice::check_numbers: finds the first pass and splat with a number that is not finite.
#include <algorithm>
#include <cmath>

#include "engine/error.h"
#include "engine/frame/picture.h"
#include "engine/gpu/read_back.h"

namespace edgesplat {
namespace {

/// "splat 17 of 230 (voxel 3, 4, 5; material 1)".
std::string named(DeviceSession& session, const CollectedSplats& list, std::uint32_t number) {
    const SplatLists& lists = list.splats.lists();
    const auto splat =
        gpu::read_back<shader::Splat>(session.device(), session.commands(), lists.splats, number, 1).front();
    const glm::uvec3 dims(list.volume.volume()->geometry.dims);
    return fmt::format("splat {} of {} (voxel {}, {}, {}; material {})", number, lists.splat_count,
                       splat.voxel % dims.x, splat.voxel / dims.x % dims.y, splat.voxel / dims.x / dims.y,
                       splat.edge >> 28U);
}

/// Index of the first number that is not finite; the size if there is none.
std::size_t first_bad(std::span<const float> pixels) {
    const auto bad = std::ranges::find_if(pixels, [](float v) { return !std::isfinite(v); });
    return static_cast<std::size_t>(bad - pixels.begin());
}

}  // namespace

void check_splats(DeviceSession& session, const CollectedSplats& list) {
    const SplatLists& lists = list.splats.lists();
    const std::size_t count = lists.splat_count;
    if (!lists.values || count == 0) return;
    const auto values = gpu::read_back<float>(session.device(), session.commands(), lists.values, 0, count);
    const std::size_t bad = first_bad(values);
    if (bad == values.size()) return;
    fail("2_collect_splats: {}: its classified value is {}, expected a finite number",
         named(session, list, static_cast<std::uint32_t>(bad)), values[bad]);
}

void PictureDrawer::check_picture() {
    const auto pixels = [&] { return floats(targets_.pixels(plan_)); };
    const std::size_t bad = first_bad(pixels());
    if (bad == pixels().size()) return;
    const std::size_t pixel = bad / 4, width = static_cast<std::size_t>(plan_.params.size.x);
    const std::string where = fmt::format("pixel {}, {}, channel {} is {}, expected a finite number", pixel % width,
                                          pixel / width, bad % 4, pixels()[bad]);

    // Bisection for n: the picture of the first n splats is finite, that of n + 1 is not.
    const std::uint32_t all = plan_.params.splat_count;
    const auto sound = [&](std::uint32_t splats) {
        draw_first(plan_, splats);
        draw_planned();
        return first_bad(pixels()) == pixels().size();
    };
    if (!sound(0)) fail("7_resolve: {}, even without splats", where);
    std::uint32_t good = 0, not_good = all;
    while (not_good - good > 1) {
        const std::uint32_t middle = good + (not_good - good) / 2;
        (sound(middle) ? good : not_good) = middle;
    }
    draw_first(plan_, all);
    const auto begun = [&](const shader::VolumeParams& volume) { return volume.first_splat <= good; };
    const auto volume = static_cast<std::size_t>(std::ranges::count_if(plan_.together, begun));
    if (volume > 0) good -= plan_.together[volume - 1].first_splat;
    fail("{}: {}: {}", plan_.variant.tiles ? "5_draw_tiles" : "5_draw_splats", named(*session_, lists_[volume], good),
         where);
}

}  // namespace edgesplat
