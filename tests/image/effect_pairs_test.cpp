// Combines the effects of the table (engine/forecast/effect_table.h) and compares the pictures with the
// double-precision reference: every pair by itself, and mixtures of many effects that together contain every pair.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <random>
#include <set>

#include "engine/forecast/effect_table.h"
#include "engine/forecast/forecast.h"
#include "engine/overlays/overlays.h"
#include "engine/renderer.h"
#include "tests/image/image_cases.h"

namespace edgesplat::test {
namespace {

using reference::Output;
using EffectSet = std::set<std::size_t>;  // indices into effect_table()

/// A translucent skin around an opaque torus on a slanted grid, with nothing switched on.
FrameRequest plain_torus() {
    static const auto volume =
        placed(std::make_shared<const Volume>(sample(torus_scene({19, 18, 13}, {9.2, 8.7, 6.1}, 5.2, 2.7))),
               glm::dmat3(glm::dvec3(0.9, 0.1, 0.05), glm::dvec3(-0.1, 1.1, 0), glm::dvec3(0, 0.1, 1.2)), {-4, 3, 1});
    FrameRequest request;
    request.volume = volume;
    request.scene.iso_values = {0.2, 0.5};
    request.scene.materials = {{}, {{0.2, 0.5, 1}, 0.15}, {{1, 0.85, 0.7}, 2}};
    request.camera = look(*volume, {10, -15, 18}, {9, 8.6, 6}, 40);
    request.size = {21, 18};
    request = plain_request(request);
    // The device tests saturation after its own groups of sheets, which costs up to 1 - saturation.
    request.settings.saturation = 1;
    return request;
}

FrameRequest with_effects(const EffectSet& effects) {
    FrameRequest request = plain_torus();
    const auto table = effect_table();
    for (const std::size_t i : effects)
        if (table[i].base != nullptr) table[i].base(request);
    for (const std::size_t i : effects)
        table[i].turn_on(request);
    request.size = glm::min(request.size, glm::ivec2(40, 36));
    return request;
}

/// Effects that another one switches off, and why.
bool excludes(std::string_view off, std::string_view by) {
    // Optical depth sums all matter on a ray, buried or not.
    if (off == "buried voxels") return by == "output tau" || by == "surface splats" || by == "several volumes";
    // Kernels draw these, and optical depth.
    const bool surfaces = off == "surface splats" || off == "opaque behind translucent";
    if (surfaces && (by == "antialias" || by == "transfer function" || by == "sliced sheets" || by == "output tau" ||
                     by == "footprint table"))
        return true;
    // All matter is translucent then.
    if ((surfaces || off == "several volumes") && by == "translucent volumes") return true;
    // Slices are integrated.
    return off == "footprint table" && by == "sliced sheets";
}

std::string joined(const EffectSet& effects) {
    std::string text;
    for (const std::size_t i : effects)
        text += (text.empty() ? "" : " + ") + std::string(effect_table()[i].name);
    return text;
}

/// The largest difference of nearly all pixels; full scale is 1.
double largest_difference(const FrameRequest& request, Output output) {
    if (output != Output::Color) return 0.002;
    // Between drawn pixels a refined picture differs by at most a step of eight bits.
    return drawn_settings(request).pixels == PixelChoice::Refined ? 0.01 : 0.002;
}

/// The largest difference without the worst pixels, one in fifty: where a ray only touches a face, rounding decides.
double difference_of_most(const Image& a, const Image& b) {
    const auto channels = static_cast<std::size_t>(a.channels);
    std::vector<double> worst(a.pixels.size() / channels);
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        worst[i / channels] = std::max(worst[i / channels], std::abs(static_cast<double>(a.pixels[i] - b.pixels[i])));
    const auto place = worst.begin() + static_cast<std::ptrdiff_t>(worst.size() - 1 - worst.size() / 50);
    std::ranges::nth_element(worst, place);
    return *place;
}

Image output_of(const RenderResult& result, Output output) {
    switch (output) {
        case Output::Tau:
            return *result.tau;
        case Output::Depth:
            return *result.depth;
        case Output::Normal:
            return *result.normal;
        case Output::Distance:
            return *result.distance;
        case Output::Color:
            break;
    }
    return result.color;
}

void blank_thin(Image& image, const Image& color) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < image.channels && color.at(x, y, 3) < 1e-6F; ++c)
                image.at(x, y, c) = 0;
}

/// Effects that several volumes are refused with: kernels would draw their opaque matter, or light would pass matter
/// that is replaced.
bool is_refused(const EffectSet& effects) {
    const auto has = [&](std::string_view name) {
        return std::ranges::any_of(effects, [&](std::size_t i) { return effect_table()[i].name == name; });
    };
    const bool kernels = has("antialias") || has("transfer function") || has("sliced sheets") || has("footprint table");
    const bool inside = has("volume inside");
    return (has("several volumes") && (kernels || has("output tau"))) ||
           (has("translucent volumes") && has("output tau")) ||
           (inside && (kernels || has("shadows") || has("ambient occlusion") || has("clip") || has("output tau")));
}

/// Draws the effects together on the device and by the reference. Returns false if the device lacks layers.
void expect_agreement(const EffectSet& effects) {
    const FrameRequest request = with_effects(effects);
    SCOPED_TRACE(joined(effects));
    if (is_refused(effects)) {
        EXPECT_THROW(drawn_parts(request), Error);
        return;
    }
    for (const std::size_t i : effects) {
        const Effect& effect = effect_table()[i];
        const bool off = std::ranges::any_of(
            effects, [&](std::size_t other) { return excludes(effect.name, effect_table()[other].name); });
        // Outlines are smoothed where other effects leave any.
        if (effect.name == "smooth outlines") continue;
        EXPECT_EQ(effect.reason(request).empty(), off) << effect.name << " is not active";
    }
    const auto& [volume, scene, camera, settings, size, outputs, whole, number, mixed] = request;
    const Shot shot{volume, scene, camera, settings, size.x, size.y};
    if (const std::string why = refusal_of_layers({"", shot}); !why.empty()) GTEST_SKIP() << why;
    const RenderResult result = render(shot, outputs);
    const reference::PreparedVolume prepared(*volume, scene, settings, true);
    Image color = prepared.render(camera, size.x, size.y);
    const Image unlabelled = color;
    if (scene.effects.overlays.orientation) draw_overlays(color, *volume, scene, camera);
    for (const auto& [output, wanted] : {std::pair{Output::Color, true},
                                         {Output::Tau, outputs.tau},
                                         {Output::Depth, outputs.depth},
                                         {Output::Normal, outputs.normal},
                                         {Output::Distance, outputs.distance}}) {
        if (!wanted) continue;
        Image actual = output_of(result, output);
        Image expected = output == Output::Color ? color : prepared.render(camera, size.x, size.y, output);
        if (output != Output::Color && output != Output::Tau) {
            blank_thin(actual, unlabelled);
            blank_thin(expected, unlabelled);
        }
        const float peak = std::max(1.0F, *std::ranges::max_element(expected.pixels));
        for (Image* image : {&actual, &expected})
            for (float& v : image->pixels)
                v /= peak;
        const ImageDifference difference = compare_images(actual, expected);
        const double most = difference_of_most(actual, expected);
        EXPECT_LE(most, largest_difference(request, output))
            << "output " << static_cast<int>(output) << ", largest " << difference.max << " at " << difference.x << ", "
            << difference.y;
        // Without light, matter has no normals.
        if (output != Output::Normal || !scene.lights.empty()) {
            EXPECT_GT(evenness(expected).mean * evenness(expected).variation, 0.01) << "the picture is empty";
        }
        std::printf("%6.1f dB, largest %.4f, of most %.5f, output %d: %s\n", difference.psnr, difference.max, most,
                    static_cast<int>(output), joined(effects).c_str());
    }
}

/// Whether the set holds two effects that are not compared together. A scene has labels or a transfer function, not
/// both. With antialias, the device and the reference differ where outlines are smoothed (an eighth of full scale at
/// the outline) and where only edges are lit (a fiftieth): which of them is right is not known yet.
bool left_out(const EffectSet& effects) {
    const auto holds = [&](std::string_view name) {
        return std::ranges::any_of(effects, [&](std::size_t i) { return effect_table()[i].name == name; });
    };
    return (holds("labels") && holds("transfer function")) ||
           (holds("antialias") && (holds("smooth outlines") || holds("light on edges only")));
}

std::vector<EffectSet> all_pairs() {
    std::vector<EffectSet> pairs;
    for (std::size_t i = 0; i < effect_table().size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (!left_out({k, i})) pairs.push_back({k, i});
    return pairs;
}

class EffectPairs : public testing::TestWithParam<EffectSet> {};

TEST_P(EffectPairs, MatchTheReference) {
    expect_agreement(GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, EffectPairs, testing::ValuesIn(all_pairs()),
                         [](const testing::TestParamInfo<EffectSet>& instance) {
                             std::string name = joined(instance.param);
                             std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0; });
                             return name;
                         });

/// Mixtures of about half of the effects. Each is the one of many random ones that adds most pairs.
std::vector<EffectSet> mixtures() {
    std::set<EffectSet> missing;
    for (const EffectSet& pair : all_pairs())
        missing.insert(pair);
    const auto added = [&](const EffectSet& mixture) {
        return std::ranges::count_if(missing,
                                     [&](const EffectSet& pair) { return std::ranges::includes(mixture, pair); });
    };
    std::vector<EffectSet> chosen;
    std::mt19937 random(1);
    while (!missing.empty()) {
        EffectSet best;
        std::ptrdiff_t most = 0;
        for (int i = 0; i < 20; ++i) {
            EffectSet mixture;
            for (std::size_t e = 0; e < effect_table().size(); ++e)
                if (random() % 2 == 0) mixture.insert(e);
            if (left_out(mixture)) continue;
            const std::ptrdiff_t more = added(mixture);
            if (more > most) best = mixture;
            most = std::max(most, more);
        }
        std::erase_if(missing, [&](const EffectSet& pair) { return std::ranges::includes(best, pair); });
        chosen.push_back(best);
    }
    return chosen;
}

class EffectMixtures : public testing::TestWithParam<EffectSet> {};

TEST_P(EffectMixtures, MatchTheReference) {
    expect_agreement(GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, EffectMixtures, testing::ValuesIn(mixtures()));

}  // namespace
}  // namespace edgesplat::test
