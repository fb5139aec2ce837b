// A change of the scene runs only those of passes 1 and 2 whose inputs it changes, and leaves what a collection from
// scratch gives.
#include <set>

#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

using Passes = std::set<std::string>;

struct SceneChange {
    std::string name;
    void (*apply)(PassScene&);
    Passes run;  ///< passes that it runs
};

const Passes kAll{"1a_mark_buried", "1_estimate_edges", "2_collect_splats"};
const Passes kLists{"2_collect_splats"};

/// Applies each change to a collected scene. Compares the passes that run, and the results with those from scratch.
void expect_runs(const PassScene& before, const std::vector<SceneChange>& changes) {
    for (const auto& [name, apply, run] : changes) {
        SCOPED_TRACE(name);
        DeviceUnderTest& state = prepared(before);
        PassScene after = before;
        apply(after);
        validate(after.scene);
        EXPECT_EQ(state.collect(after.scene, after.settings), !run.empty());
        Passes ran;
        for (const PassTime& time : state.cost.times)
            ran.insert(time.name);
        EXPECT_EQ(ran, run);
        EXPECT_EQ(state.cost.voxels_estimated > 0, run.contains("1_estimate_edges"));
        if (run == kAll) continue;
        const auto picture = [&] {
            state.draw(after.scene, after.camera, after.settings, {40, 36}, shader::PAYLOAD_COLOR);
            const auto pixels = state.targets().output.mapped<glm::vec4>(40 * 36);
            return std::vector<glm::vec4>(pixels.begin(), pixels.end());
        };
        const auto words_of = [&](const gpu::Buffer& list) {
            return list ? download<std::uint32_t>(state, list, list.bytes() / 4) : std::vector<std::uint32_t>();
        };
        const auto drawn = picture();
        const auto splats = words_of(state.lists().splats), traits = words_of(state.lists().traits),
                   values = words_of(state.lists().values);
        state.level.splats.drop();
        EXPECT_TRUE(state.collect(after.scene, after.settings));
        EXPECT_TRUE(words_of(state.lists().splats) == splats);
        EXPECT_TRUE(words_of(state.lists().traits) == traits);
        EXPECT_TRUE(words_of(state.lists().values) == values);
        EXPECT_TRUE(picture() == drawn);
    }
}

TEST(StaleResults, OfMaterialsAreRunAgain) {
    PassScene torus = pass_scenes()[0];
    torus.scene.iso_values = {0.2, 0.5};
    torus.scene.materials = {{}, {{0.2, 0.5, 1}, 0.15}, {{1, 0.85, 0.7}, 4}};
    torus.scene.lights = {directional_light({0.3, -1, 0.5})};
    expect_runs(torus, {
                           {"nothing", [](PassScene&) {}, {}},
                           {"colour",
                            [](PassScene& s) {
                                s.scene.materials[2].color = {0, 1, 0};
                            },
                            {}},
                           {"light",
                            [](PassScene& s) {
                                s.scene.lights = {directional_light({1, 0, 0}), Light{}};
                            },
                            {}},
                           {"response", [](PassScene& s) { s.scene.materials[2].response.specular = 0.5; }, {}},
                           {"extinction", [](PassScene& s) { s.scene.materials[1].extinction = 0.2; }, {}},
                           {"opaque extinction", [](PassScene& s) { s.scene.materials[2].extinction = 4.1; }, {}},
                           {"sheet spacing", [](PassScene& s) { s.settings.sheet_spacing = 0.5; }, {}},
                           {"clip plane",
                            [](PassScene& s) {
                                s.scene.effects.clip.keep = {{{13, 12, 9}, {1, 0, 0}}};
                            },
                            kAll},
                           {"removed skin", [](PassScene& s) { s.scene.materials[1].extinction = 0; }, kLists},
                           {"deeper opaque matter", [](PassScene& s) { s.scene.materials[2].extinction = 1; }, kAll},
                           {"nothing opaque",
                            [](PassScene& s) { s.scene.materials[2].extinction = 0.3; },
                            {"1_estimate_edges", "2_collect_splats"}},
                           {"all opaque", [](PassScene& s) { s.scene.materials[1].extinction = 3; }, kAll},
                           {"iso-value", [](PassScene& s) { s.scene.iso_values[1] = 0.55; }, kAll},
                           {"estimator",
                            [](PassScene& s) { s.settings.edges = EdgeEstimator::March; },
                            {"1_estimate_edges", "2_collect_splats"}},
                       });
}

TEST(StaleResults, OfTransferFunctionsAreRunAgain) {
    PassScene orbital = pass_scenes()[1];
    const double top = static_cast<double>(orbital.volume.max_value);
    orbital.scene.iso_values = {0.4 * top};
    orbital.scene.materials = {{}, {}};
    orbital.scene.transfer = {{0.03 * top, {0.1, 0.2, 1}, 0},
                              {0.15 * top, {0.1, 0.8, 0.6}, 0.1},
                              {0.4 * top, {1, 0.5, 0.1}, 0.2},
                              {top, {1, 0.1, 0.1}, 0.3}};
    expect_runs(
        orbital,
        {
            {"nothing", [](PassScene&) {}, {}},
            {"colour",
             [](PassScene& s) {
                 s.scene.transfer[2].color = {0, 0, 1};
             },
             {}},
            {"extinction", [](PassScene& s) { s.scene.transfer[2].extinction = 0.25; }, {}},
            {"point inside", [](PassScene& s) { s.scene.transfer[2].value *= 1.1; }, {}},
            {"one more point",
             [](PassScene& s) {
                 s.scene.transfer.insert(s.scene.transfer.begin() + 2, {0.5 * s.scene.transfer[3].value, {}, 0.1});
                 std::swap(s.scene.transfer[2], s.scene.transfer[3]);
             },
             {}},
            {"end of the support", [](PassScene& s) { s.scene.transfer[0].value *= 1.5; }, kLists},
            {"a point at 0", [](PassScene& s) { s.scene.transfer[1].extinction = 0; }, kLists},
            {"no function",
             [](PassScene& s) {
                 s.scene.transfer.clear();
                 s.scene.materials[1].extinction = 0.2;
             },
             kLists},
        });
}

}  // namespace
}  // namespace edgesplat::test
