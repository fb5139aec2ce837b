#include "engine/accuracy/choose_settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "engine/accuracy/configurations.h"
#include "engine/accuracy/metrics.h"
#include "engine/error.h"
#include "engine/reference/direct_evaluation.h"
#include "engine/scene/ladder.h"

namespace edgesplat::accuracy {
namespace {

constexpr double kProxyPixels = 112;  ///< longer side of the small picture
constexpr int kRounds = 3;

enum class Tier { Cheap, Dear };

/// Methods that were on or near the front of measured volumes. The base's own is always the first cheap one.
std::vector<Settings> candidates(const Settings& base, Tier tier) {
    struct Row {
        SheetCut sheets;
        double spacing;
    };
    using S = SheetCut;
    const std::vector<Row> cheap{{S::Whole, 2}, {S::Whole, 1}, {S::Whole, 0.5}};
    const std::vector<Row> dear{{S::Sliced, 1}, {S::Sliced, 0.5}, {S::Sliced, 0.25}, {S::Sliced, 0.1}};
    const Settings& accurate = preset_named("accurate").settings;
    std::vector<Settings> list;
    if (tier == Tier::Cheap) list.push_back(base);
    std::vector<std::string> known{settings_key(base)};
    for (const Row& row : tier == Tier::Cheap ? cheap : dear) {
        Settings s = base;
        s.footprints = FootprintMode::Procedural;
        s.sheets = row.sheets;
        s.sheet_spacing = row.spacing;
        s.sheet_format = SheetFormat::Tiles;
        if (tier == Tier::Dear) {
            s.saturation = accurate.saturation;
            s.pixels = accurate.pixels;
        }
        const std::string key = settings_key(s);
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        known.push_back(key);
        list.push_back(s);
    }
    return list;
}

std::string percent(double share) {
    return fmt::format("{:.3g} %", 100 * share);
}

}  // namespace

double error_share(std::string_view text) {
    const bool in_percent = text.ends_with('%');
    std::string_view digits = text.substr(0, text.size() - (in_percent ? 1 : 0));
    while (digits.ends_with(' '))
        digits.remove_suffix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (in_percent) value /= 100;
    if (error != std::errc() || end != digits.data() + digits.size() || !(value > 0) || !(value < 1))
        fail("'{}': expected an error above 0 and below 1, such as 0.005 or 0.5%", text);
    return value;
}

ChosenSettings choose_settings(Renderer& renderer, const Volume& volume, const Scene& scene, const Camera& camera,
                               int width, int height, const ErrorLimit& limit) {
    if (!(limit.rms > 0 && limit.rms < 1)) fail("error limit {}: expected a number above 0 and below 1", limit.rms);
    const double scale = std::min(1.0, kProxyPixels / std::max(width, height));
    ChosenSettings result;
    result.size = glm::max(glm::ivec2(1), glm::ivec2(std::lround(width * scale), std::lround(height * scale)));

    const reference::PreparedVolume model(volume, scene, model_of(limit.base));
    const reference::DirectOptions options{std::clamp(limit.rms / 10, 1e-6, 1e-3), {}};
    const reference::DirectResult expected =
        reference::direct_evaluation(model, camera, result.size.x, result.size.y, reference::Output::Color, options);
    result.reference_error = expected.error_estimate;

    const auto is_good_enough = [&](const TriedSettings& t) { return kErrorMargin * t.error <= limit.rms; };
    for (const Tier tier : {Tier::Cheap, Tier::Dear}) {
        if (std::any_of(result.tried.begin(), result.tried.end(), is_good_enough)) break;
        for (const Settings& settings : candidates(limit.base, tier)) {
            const RenderResult picture = renderer.render(scene, camera, settings, result.size.x, result.size.y);
            result.tried.push_back(
                {settings, image_error(picture.color, expected.image).rms, std::numeric_limits<double>::infinity()});
        }
    }
    // Only methods that are good enough are timed, in turns, so that other load on the machine affects all alike.
    for (int round = 0; round < kRounds; ++round)
        for (TriedSettings& tried : result.tried) {
            if (!is_good_enough(tried) && tried.settings != limit.base) continue;
            renderer.render(scene, camera, tried.settings, result.size.x, result.size.y);  // warm-up: tables, formats
            for (int frame = 0; frame < 2; ++frame)
                tried.milliseconds = std::min(
                    tried.milliseconds, renderer.render(scene, camera, tried.settings, result.size.x, result.size.y)
                                            .stats.frame_milliseconds);
        }
    result.default_milliseconds = result.tried.front().milliseconds;
    std::stable_sort(result.tried.begin(), result.tried.end(),
                     [](const TriedSettings& a, const TriedSettings& b) { return a.milliseconds < b.milliseconds; });
    const auto good = std::find_if(result.tried.begin(), result.tried.end(), is_good_enough);
    if (good == result.tried.end()) {
        const auto best = std::min_element(result.tried.begin(), result.tried.end(),
                                           [](const auto& a, const auto& b) { return a.error < b.error; });
        const std::string how = difference(best->settings, limit.base);
        fail("no method has an error below {} in this view; the lowest is {} with {}", percent(limit.rms),
             percent(kErrorMargin * best->error), how.empty() ? "the given settings" : how);
    }
    result.chosen = *good;
    result.expected_error = kErrorMargin * good->error;
    return result;
}

}  // namespace edgesplat::accuracy
