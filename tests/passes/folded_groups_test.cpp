// Dispatches of more workgroups than an axis allows are folded into rows. Folding short ones as well changes no bit.
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/passes/traced_scenes.h"

namespace edgesplat::test {
namespace {

/// Folds dispatches above `groups` workgroups.
class Folding {
  public:
    Folding(gpu::Commands& commands, std::uint32_t groups) : commands_(&commands) { commands.fold_above(groups); }
    ~Folding() { commands_->fold_above(gpu::Commands::kMostGroups); }
    Folding(const Folding&) = delete;
    Folding& operator=(const Folding&) = delete;

  private:
    gpu::Commands* commands_;
};

using Words = std::vector<std::uint32_t>;

/// Everything that the passes of a frame leave: fields, lists, picture.
std::map<std::string, Words> left_by(const PassScene& s, const glm::ivec2& size, std::uint32_t groups) {
    DeviceUnderTest& state = prepared(s);
    const Folding folding(state.commands(), groups);
    state.level.splats.drop();
    state.collect(s.scene, s.settings);
    state.draw(s.scene, s.camera, s.settings, size, shader::PAYLOAD_COLOR);
    const SplatLists& lists = state.lists();
    std::map<std::string, Words> left;
    if (lists.buried)
        for (const std::uint8_t mark : download<std::uint8_t>(state, lists.buried))
            left["buried mask"].push_back(mark);
    for (const glm::uvec2& words : download<glm::uvec2>(state, lists.edges))
        left["edge field"].insert(left["edge field"].end(), {words.x, words.y});
    for (const auto& [name, list] : {std::pair{"splats", &lists.splats},
                                     {"traits", &lists.traits},
                                     {"values", &lists.values},
                                     {"occlusion", &lists.occlusion},
                                     {"shadows", &lists.shadows}})
        if (*list) left[name] = download<std::uint32_t>(state, *list, list->bytes() / 4);
    const auto pixels = state.targets().output.mapped<std::uint32_t>(static_cast<std::size_t>(4 * size.x * size.y));
    left["picture"].assign(pixels.begin(), pixels.end());
    return left;
}

struct FoldedCase {
    PassScene scene;
    glm::ivec2 size;
};

/// Together they run every pass that is dispatched along a line.
std::vector<FoldedCase> folded_cases() {
    std::vector<FoldedCase> cases;
    PassScene wall = pass_scenes()[2];
    wall.scene.effects.clip.keep = {{wall.volume.geometry.center() + glm::dvec3(5, 0, 0), {1, 0, 0}}};
    cases.push_back({wall, {100, 81}});
    PassScene gyroid = traced_scenes()[1];
    gyroid.scene.lights = {directional_light({0.3, -1, 0.5})};
    gyroid.scene.effects.occlusion = AmbientOcclusion{.radius = 4};
    cases.push_back({gyroid, {80, 60}});
    PassScene surfaces = traced_scenes()[2];
    surfaces.settings.opaque = OpaqueMatter::Surfaces;
    cases.push_back({surfaces, {80, 60}});
    PassScene mixed = pass_scenes()[1];
    mixed.scene.materials.back().extinction = 8;
    mixed.settings.opaque = OpaqueMatter::Surfaces;
    cases.push_back({mixed, {80, 60}});
    PassScene several = mixed;
    auto beside = std::make_shared<Volume>(several.volume);
    beside->geometry.origin += glm::dvec3(3, 4, 5);
    several.scene.added = {{.volume = beside,
                            .iso_values = {several.scene.iso_values.back()},
                            .materials = {{}, several.scene.materials.back()},
                            .transfer = {},
                            .label_colors = {}}};
    cases.push_back({several, {80, 60}});
    PassScene shaded = pass_scenes()[0];
    shaded.scene.lights = {directional_light({0.3, -1, 0.5})};
    shaded.scene.lights[0].shadows = true;
    cases.push_back({shaded, {40, 30}});
    return cases;
}

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// The shaders that number their groups along a line, by name; with side-by-side sorts or without.
std::set<std::string> line_shaders(bool side_by_side) {
    std::set<std::string> names;
    const std::filesystem::path folder = std::filesystem::path(EDGESPLAT_SOURCE_DIR) / "shaders";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".comp") continue;
        const std::string text = text_of(entry.path());
        const bool columns = text.find("tiles_cpu/tile_entries.glsl") != std::string::npos;
        if (columns || text.find("common/groups.glsl") != std::string::npos)
            names.insert(entry.path().filename().string());
    }
    const std::set<std::string> in_columns{"4d_count_tiles.comp", "4f_scatter_tiles.comp"};
    const std::set<std::string> in_parallel{"4a_count_slots.comp", "4b_sum_sheets.comp", "4e_sum_tiles.comp"};
    for (const std::string& name : side_by_side ? in_columns : in_parallel)
        EXPECT_EQ(names.erase(name), 1U) << name;
    return names;
}

TEST(FoldedGroups, ChangeNoBitOfAnyPass) {
    DeviceUnderTest& state = device_under_test();
    const gpu::DeviceProfile& profile = state.device().profile();
    std::set<std::string> expected = line_shaders(profile.side_by_side);
    if (!profile.refines) expected.erase("5_refine_pixels.comp");
    state.session.pipelines().forget_used();
    for (const auto& [scene, size] : folded_cases()) {
        SCOPED_TRACE(scene.name);
        const auto straight = left_by(scene, size, gpu::Commands::kMostGroups);
        const auto folded = left_by(scene, size, 3);
        ASSERT_EQ(straight.size(), folded.size());
        for (const auto& [name, words] : straight) {
            ASSERT_FALSE(words.empty()) << name;
            EXPECT_TRUE(words == folded.at(name)) << name;
        }
    }
    for (const gpu::PipelineVariant& used : state.session.pipelines().used())
        for (const char* shader : used.shaders)
            expected.erase(shader);
    EXPECT_TRUE(expected.empty()) << "not run: " << *expected.begin();
}

TEST(FoldedGroups, CoverTheLineOnce) {
    gpu::Commands& commands = device_under_test().commands();
    for (const std::uint32_t most : {1U, 3U, 7U, gpu::Commands::kMostGroups}) {
        const Folding folding(commands, most);
        for (const std::uint64_t count : {0ULL, 1ULL, 64ULL, 65ULL, 1000ULL, 4194240ULL, 4194241ULL, 4294836225ULL}) {
            const glm::uvec3 groups = commands.workgroups({"3_select_footprints.comp", {}, gpu::Invocations{count}});
            const std::uint64_t needed = std::max<std::uint64_t>((count + 63) / 64, 1);
            EXPECT_LE(groups.x, most);
            EXPECT_GE(std::uint64_t{groups.x} * groups.y, needed);
            EXPECT_LT(std::uint64_t{groups.x} * groups.y, needed + groups.y) << "a surplus row";
        }
    }
}

/// A shader that reads a number of a workgroup or invocation along x alone, or folds it by itself, breaks when its
/// dispatch is folded. The other reads are of pictures and bricks, or of dispatches of a fixed size.
TEST(FoldedGroups, AreNumberedInOnePlace) {
    const std::set<std::string> others{"groups.glsl",          "7_resolve.comp",         "2c_sweep_light.comp",
                                       "brick_list.glsl",      "raycast_bricks.comp",    "raycast_leaps.comp",
                                       "raycast.glsl",         "4d_count_pairs.comp",    "4f_scatter_pairs.comp",
                                       "4a_count_sheets.comp", "4c_scatter_splats.comp", "4c_scatter_slots.comp"};
    const std::filesystem::path folder = std::filesystem::path(EDGESPLAT_SOURCE_DIR) / "shaders";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file() || others.contains(entry.path().filename().string())) continue;
        const std::string text = text_of(entry.path());
        for (const char* read : {"gl_WorkGroupID", "gl_GlobalInvocationID", "gl_NumWorkGroups"})
            EXPECT_EQ(text.find(read), std::string::npos) << entry.path() << " reads " << read;
    }
}

}  // namespace
}  // namespace edgesplat::test
