// Light, materials' response, silhouettes, fog and transfer functions: passes 2 and 5 against the reference.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

constexpr glm::ivec2 kShadingSize{56, 48};
constexpr std::size_t kShadingPixels = static_cast<std::size_t>(kShadingSize.x) * kShadingSize.y;

Light point_light(const glm::dvec3& position, const glm::dvec3& color = glm::dvec3(1), double intensity = 0.85) {
    Light light;
    light.kind = Light::Kind::Point;
    light.position = position;
    light.color = color;
    light.intensity = intensity;
    return light;
}

/// Colour and extinction ramps over the orbital's values, with `iso_count` iso-values.
void ramp(PassScene& s, std::size_t iso_count) {
    const double top = static_cast<double>(s.volume.max_value);
    s.scene.transfer = {{0.05 * top, {0.1, 0.3, 1}, 0},
                        {0.2 * top, {0.2, 0.9, 0.4}, 0.3},
                        {0.4 * top, {1, 0.9, 0.2}, 1},
                        {0.7 * top, {1, 0.2, 0.1}, 3}};
    s.scene.iso_values.resize(iso_count);
    s.scene.materials.resize(iso_count + 1);
    s.settings = canonical_settings(s.settings, s.scene);
}

/// A core with an edge, in a haze without edges.
void haze(PassScene& s) {
    ramp(s, 1);
    s.scene.iso_values = {0.4 * static_cast<double>(s.volume.max_value)};
}

struct ShadingVariant {
    const char* name;
    void (*change)(PassScene&);
    std::vector<std::size_t> scenes = {0, 1};
    void (*usual)(PassScene&) = [](PassScene&) {};  ///< the picture to compare with
};

void PrintTo(const ShadingVariant& variant, std::ostream* out) {
    *out << variant.name;
}

glm::dvec3 beside(const PassScene& s) {
    return s.volume.geometry.to_world({30, -6, 25});
}

const std::vector<ShadingVariant>& variants() {
    static const std::vector<ShadingVariant> all{
        {"unlit", [](PassScene& s) { s.scene.lights.clear(); }},
        {"point_light", [](PassScene& s) { s.scene.lights = {point_light(beside(s))}; }, {0, 1, 2}},
        {"point_light_in_the_volume",
         [](PassScene& s) {
             s.scene.lights = {point_light(s.volume.geometry.to_world({12, 12, 9}))};
         }},
        {"point_light_far_away",
         [](PassScene& s) {
             s.scene.lights = {point_light({1e30, -3e30, 2e30})};
         }},
        {"two_colours",
         [](PassScene& s) {
             s.scene.lights = {directional_light({1, -1, 2}), point_light(beside(s), {0.2, 0.4, 1}, 1.5)};
             s.scene.lights[0].color = {1, 0.3, 0};
         }},
        {"four_lights",
         [](PassScene& s) {
             s.scene.lights = {Light{}, directional_light({1, 0, 0}), point_light(beside(s)),
                               directional_light({0, 1e-200, 1e-200})};
             for (Light& light : s.scene.lights)
                 light.intensity = 0.4;
         }},
        {"response",
         [](PassScene& s) {
             for (Material& m : s.scene.materials)
                 m.response = {.ambient = 2, .diffuse = 0.3};
         }},
        {"gloss",
         [](PassScene& s) {
             s.scene.lights = {point_light(beside(s)), Light{}};
             double specular = 0.2;
             for (Material& m : s.scene.materials) {
                 m.response = {.ambient = 1, .diffuse = 0.6, .specular = specular, .shininess = 10 + 100 * specular};
                 specular += 0.3;
             }
         },
         {0, 1, 2}},
        {"lit_edges",
         [](PassScene& s) {
             haze(s);
             s.scene.lit = Lit::Edges;
         },
         {1},
         haze},
        {"lit_edges_without_edges",
         [](PassScene& s) {
             s.scene.lit = Lit::Edges;
             s.settings.edges = EdgeEstimator::Off;
             s.settings = canonical_settings(s.settings);
         },
         {0, 1},
         [](PassScene& s) {
             s.settings.edges = EdgeEstimator::Off;
             s.settings = canonical_settings(s.settings);
         }},
        {"fog",
         [](PassScene& s) {
             s.scene.effects.fog = Fog{{0.5, 0.6, 0.7}, 0.05, 20};
         }},
        {"fog_sliced",
         [](PassScene& s) {
             s.scene.effects.fog = Fog{{0.5, 0.6, 0.7}, 0.05, 20};
             s.settings.sheets = SheetCut::Sliced;
         }},
        {"silhouette",
         [](PassScene& s) {
             s.scene.effects.silhouette = Silhouette{{0.1, 0, 0.3}, 0.9, 2};
         },
         {0, 1, 2}},
        {"silhouette_unlit_plain",
         [](PassScene& s) {
             s.scene.lights.clear();
             s.scene.effects.silhouette = Silhouette{{1, 0, 0}, 1, 0.25};
             s.settings.edges = EdgeEstimator::Off;
             s.settings = canonical_settings(s.settings);
         }},
        {"everything",
         [](PassScene& s) {
             s.scene.lights = {point_light(beside(s), {1, 0.5, 0.2}), Light{}};
             s.scene.materials.back().response = {.ambient = 0.5, .diffuse = 0.8, .specular = 0.7, .shininess = 60};
             s.scene.effects.silhouette = Silhouette{};
             s.scene.effects.fog = Fog{{0.2, 0.2, 0.3}, 0.02, 10};
             s.scene.lit = Lit::Edges;
         }},
        {"transfer_without_iso_values", [](PassScene& s) { ramp(s, 0); }, {1}},
        {"transfer_with_one_iso_value", [](PassScene& s) { ramp(s, 1); }, {1}},
        {"transfer_with_two_iso_values", [](PassScene& s) { ramp(s, 2); }, {1}},
        {"transfer_sliced_glossy",
         [](PassScene& s) {
             ramp(s, 2);
             s.settings.sheets = SheetCut::Sliced;
             s.scene.materials[1].response.specular = 0.8;
         },
         {1}},
    };
    return all;
}

PassScene changed(const ShadingVariant& variant, std::size_t number) {
    PassScene s = pass_scenes()[number];
    // Thick sheets: all are in one group, and still on the device after the frame.
    s.settings.sheet_spacing = 6;
    s.settings.saturation = 1;
    variant.change(s);
    return s;
}

class Shading : public testing::TestWithParam<ShadingVariant> {};

TEST_P(Shading, SheetsAgreeWithTheReference) {
    if (!layers_obstacle().empty()) GTEST_SKIP() << layers_obstacle();
    for (const std::size_t number : GetParam().scenes) {
        const PassScene s = changed(GetParam(), number);
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        const auto [records, sheets, rect] = drawn_sheets(state, s, kShadingSize);
        ASSERT_EQ(state.plan().params.group_count, 1U);

        const Oracle oracle(s, records, kShadingSize);
        const int base =
            reference::sheets_of(records, oracle.field, oracle.view, s.settings, oracle.footprints).first();
        const double thickness = reference::sheet_thickness(oracle.view, s.settings);
        double peak = 0, worst = 0;
        for (std::uint32_t sheet = 0; sheet < state.plan().params.sheet_count; ++sheet) {
            const int place = static_cast<int>(sheet) + state.plan().params.sheet_base - base;
            std::vector<std::uint32_t> splats;
            for (std::uint32_t i = 0; i < records.size(); ++i) {
                if (oracle.selected[i].kept && oracle.selected[i].sheet <= place &&
                    place <= oracle.selected[i].last_sheet)
                    splats.push_back(i);
            }
            std::optional<reference::DepthRange> cut;
            const double first = base + static_cast<double>(place);
            if (s.settings.sheets == SheetCut::Sliced) cut = {thickness * first, thickness * (first + 1)};
            std::vector<glm::dvec4> want(kShadingPixels, glm::dvec4(0));
            oracle.drawer.draw(splats, reference::Payload::Color, {}, want, cut);
            for (std::size_t i = 0; i < kShadingPixels; ++i) {
                const int x = static_cast<int>(i) % kShadingSize.x, y = static_cast<int>(i) / kShadingSize.x;
                const bool inside = x >= rect.x && x < rect.z && y >= rect.y && y < rect.w;
                const glm::dvec4 got = inside ? glm::dvec4(sheets[sheet * kShadingPixels + i]) : glm::dvec4(0);
                for (int c = 0; c < 4; ++c) {
                    peak = std::max(peak, want[i][c]);
                    worst = std::max(worst, std::abs(got[c] - want[i][c]));
                }
            }
        }
        EXPECT_GT(peak, 0.2);
        EXPECT_LE(worst, 5e-5 * peak);
        std::printf("%-30s %-18s worst of peak %.1e\n", GetParam().name, s.name.c_str(), worst / peak);
    }
}

TEST_P(Shading, ChangesThePicture) {
    const std::size_t number = GetParam().scenes.front();
    const auto picture = [](const PassScene& s) {
        DeviceUnderTest& state = prepared(s);
        state.draw(s.scene, s.camera, s.settings, kShadingSize, shader::PAYLOAD_COLOR);
        const auto pixels = state.targets().output.mapped<glm::vec4>(kShadingPixels);
        return std::vector<glm::vec4>(pixels.begin(), pixels.end());
    };
    const auto usual = picture(changed({"usual", GetParam().usual}, number));
    const auto other = picture(changed(GetParam(), number));
    float most = 0;
    for (std::size_t i = 0; i < kShadingPixels; ++i) {
        for (int c = 0; c < 4; ++c) {
            ASSERT_TRUE(std::isfinite(other[i][c]));
            most = std::max(most, std::abs(other[i][c] - usual[i][c]));
        }
    }
    // Without edges, lighting only edges changes nothing.
    if (std::string(GetParam().name) == "lit_edges_without_edges")
        EXPECT_EQ(most, 0.0F);
    else
        EXPECT_GT(most, 0.01F);
}

INSTANTIATE_TEST_SUITE_P(All, Shading, testing::ValuesIn(variants()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(TransferFunction, CollectsTheReferencesSplatsAndValues) {
    for (const std::size_t iso_count : {0U, 1U, 2U}) {
        SCOPED_TRACE(iso_count);
        PassScene s = pass_scenes()[1];
        ramp(s, iso_count);
        DeviceUnderTest& state = prepared(s);
        const auto got = device_records(state);
        const std::vector<reference::VoxelEdge> edges = device_field(state);
        const auto samples = scaled_field(s.volume);
        const reference::Field field{s.volume.geometry.dims, samples, {}};
        const auto values = reference::classified_values(field, s.scaled(), edges);
        auto carried = reference::voxels_beside(field, s.scaled());
        for (reference::CarriedEdge& c : carried)
            c.value = reference::carried_value(field, s.scaled(), edges, c);
        auto want = reference::collect_splats(field, s.scaled(), edges, s.scene, s.volume.geometry, s.settings,
                                              s.camera.eye, false, values, carried);
        sort_by_brick(want, s.volume.geometry.dims);
        ASSERT_EQ(got.size(), want.size());
        std::size_t moved = 0;
        for (std::size_t i = 0; i < want.size(); ++i) {
            ASSERT_EQ(got[i].voxel, want[i].voxel);
            moved += std::abs(values[want[i].voxel] - static_cast<double>(samples[want[i].voxel])) > 1e-3 ? 1U : 0U;
            ASSERT_NEAR(got[i].classified->value, want[i].classified->value, 2e-6);
            ASSERT_NEAR(got[i].classified->extinction, want[i].classified->extinction, 5e-5);
        }
        if (iso_count > 0)
            EXPECT_GT(moved, 100U) << "no voxel was classified by a point further inside";
        else
            EXPECT_EQ(moved, 0U);
    }
}

TEST(TransferFunction, CostsNothingWhenOff) {
    PassScene s = pass_scenes()[1];
    DeviceUnderTest& state = prepared(s);
    EXPECT_FALSE(state.lists().values);
    EXPECT_FALSE(state.lists().transfer);
    ramp(s, 2);
    prepared(s);
    EXPECT_TRUE(state.lists().values);
    s.scene.transfer.clear();
    s.scene.materials.back().extinction = 1;
    state.collect(s.scene, s.settings, false);
    EXPECT_FALSE(state.lists().values);
    EXPECT_FALSE(state.lists().transfer);
}

TEST(TransferFunction, RecollectsSplatsAfterAChangedPoint) {
    PassScene s = pass_scenes()[1];
    ramp(s, 1);
    DeviceUnderTest& state = prepared(s);
    const auto before = state.lists().splat_count;
    s.scene.transfer[0].value *= 2;
    EXPECT_TRUE(state.collect(s.scene, s.settings, false));
    EXPECT_LT(state.lists().splat_count, before);
    EXPECT_FALSE(state.collect(s.scene, s.settings, false));
}

}  // namespace
}  // namespace edgesplat::test
