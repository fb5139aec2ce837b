// Splat lists that are kept between runs: the picture of a list that was read equals the picture of one that was
// computed, and no other list is ever taken.
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "engine/store/kept_splats.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

namespace fs = std::filesystem;
using testing::Gt;

/// A folder for files between runs, in place of the user's.
class KeptBetweenRuns : public testing::Test {
  protected:
    KeptBetweenRuns() {
        if (const char* before = std::getenv("EDGESPLAT_CACHE")) before_ = before;
        ::setenv("EDGESPLAT_CACHE", folder_.c_str(), 1);
    }
    ~KeptBetweenRuns() override {
        before_ ? ::setenv("EDGESPLAT_CACHE", before_->c_str(), 1) : ::unsetenv("EDGESPLAT_CACHE");
        fs::remove_all(folder_);
    }
    fs::path splats() const { return folder_ / "splats"; }
    std::vector<fs::path> files() const {
        std::vector<fs::path> out;
        for (const auto& entry : fs::directory_iterator(splats()))
            out.push_back(entry.path());
        return out;
    }
    /// A renderer as a new run of a program has it.
    static Renderer next_run() {
        return Renderer({.device = test_renderer().device().name, .validation = true, .keep_splats = true});
    }
    static RenderResult picture(Renderer& renderer, const Shot& shot) {
        renderer.set_volume(shot.volume);
        AovRequest outputs;
        outputs.depth = outputs.normal = true;
        return renderer.render(shot.scene, shot.camera, shot.settings, shot.width, shot.height, outputs);
    }

  private:
    fs::path folder_ = fs::path(testing::TempDir()) / ("kept_splats_" + std::to_string(::getpid()));
    std::optional<std::string> before_;
};

void expect_equal(const RenderResult& a, const RenderResult& b) {
    EXPECT_TRUE(a.color.pixels == b.color.pixels);
    EXPECT_TRUE(a.depth->pixels == b.depth->pixels);
    EXPECT_TRUE(a.normal->pixels == b.normal->pixels);
    EXPECT_EQ(a.stats.splats_collected, b.stats.splats_collected);
    EXPECT_EQ(a.stats.edge_splats, b.stats.edge_splats);
    EXPECT_EQ(a.stats.splats_culled, b.stats.splats_culled);
}

/// Shots of every kind of list.
std::vector<std::pair<const char*, Shot>> shots() {
    Shot opaque = torus_shot();
    for (Material& material : opaque.scene.materials)
        if (material.extinction > 0) material.extinction = 8;
    Shot mixture = torus_shot();
    mixture.scene.materials.back().extinction = 8;
    Shot translucent = torus_shot();
    translucent.scene.effects.occlusion.emplace();
    Shot gray = torus_shot();
    gray.scene.iso_values.clear();
    gray.scene.materials.resize(1);
    const double low = gray.volume->min_value, high = gray.volume->max_value;
    gray.scene.transfer = {{low, {0, 0, 0}, 0}, {0.5 * (low + high), {1, 0.5, 0}, 0.02}, {high, {1, 1, 1}, 0.4}};
    Shot cut = opaque;
    cut.scene.effects.clip.keep.push_back({{1, 0, 0}, cut.volume->geometry.to_world(glm::dvec3(12))});
    Shot plain = translucent;
    plain.settings.edges = EdgeEstimator::Off;
    return {{"opaque", opaque},          {"mixture", mixture}, {"translucent", translucent},
            {"transfer function", gray}, {"cut", cut},         {"plain", plain}};
}

TEST_F(KeptBetweenRuns, DrawTheSamePicture) {
    Renderer fresh({.device = test_renderer().device().name, .validation = true});
    Renderer first = next_run(), second = next_run();
    for (const auto& [name, shot] : shots()) {
        SCOPED_TRACE(name);
        const RenderResult computed = picture(fresh, shot);
        picture(first, shot);
        const RenderResult read = picture(second, shot);
        EXPECT_FALSE(computed.stats.splats_read);
        EXPECT_TRUE(read.stats.splats_read);
        EXPECT_EQ(read.stats.voxels_estimated, 0U);
        EXPECT_THAT(read.stats.splats_collected, Gt(100U));
        expect_equal(computed, read);
        EXPECT_EQ(second.validation_messages(), 0U);
    }
}

TEST_F(KeptBetweenRuns, AreNotThoseOfAnythingElse) {
    const Shot shot = shots().front().second;
    Renderer first = next_run();
    picture(first, shot);
    const std::size_t one = files().size();
    Shot other_samples = shot, other_iso = shot, other_estimator = shot;
    auto volume = std::make_shared<Volume>(*shot.volume);
    volume->values[volume->values.size() / 2] += 1e-3F;
    other_samples.volume = volume;
    other_iso.scene.iso_values.front() += 1e-3;
    other_estimator.settings.edges = EdgeEstimator::March;
    std::size_t expected = one;
    for (const Shot& other : {other_samples, other_iso, other_estimator}) {
        Renderer next = next_run();
        EXPECT_FALSE(picture(next, other).stats.splats_read);
        EXPECT_EQ(files().size(), ++expected);
    }
    // Colours and lights are no part of a list.
    Shot recoloured = shot;
    recoloured.scene.materials.back().color = {0.2, 0.9, 0.1};
    Renderer next = next_run();
    EXPECT_TRUE(picture(next, recoloured).stats.splats_read);
}

// Edges are not kept. What needs them again finds them again.
TEST_F(KeptBetweenRuns, CanChangeAfterwards) {
    Shot shot = torus_shot();
    shot.settings.edges = EdgeEstimator::March;
    {
        Renderer first = next_run();
        picture(first, shot);
    }
    Renderer kept = next_run(), fresh({.device = test_renderer().device().name, .validation = true});
    EXPECT_TRUE(picture(kept, shot).stats.splats_read);
    Shot hidden = shot;
    hidden.scene.materials.back().extinction = 0;
    expect_equal(picture(kept, hidden), picture(fresh, hidden));
    EXPECT_TRUE(picture(kept, shot).stats.splats_read);
    auto changed = std::make_shared<Volume>(*shot.volume);
    changed->values[changed->values.size() / 2 + 3] = changed->min_value;
    shot.volume = changed;
    const RenderResult after = picture(kept, shot);
    EXPECT_FALSE(after.stats.splats_read);
    expect_equal(after, picture(fresh, shot));
}

TEST_F(KeptBetweenRuns, AreComputedAgainIfTheFileIsDamaged) {
    const Shot shot = shots().front().second;
    Renderer first = next_run();
    const RenderResult computed = picture(first, shot);
    const fs::path file = files().front();
    const auto bytes = fs::file_size(file);
    {
        std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
        out.seekp(static_cast<std::streamoff>(bytes / 2));
        out.put('x').put('y');
    }
    Renderer second = next_run();
    const RenderResult again = picture(second, shot);
    EXPECT_FALSE(again.stats.splats_read);
    expect_equal(computed, again);
    Renderer third = next_run();
    EXPECT_TRUE(picture(third, shot).stats.splats_read) << "the file was written again";
}

TEST_F(KeptBetweenRuns, AreOptional) {
    fs::create_directories(splats().parent_path());
    std::ofstream(splats()) << "a file where the folder should be";
    const Shot shot = shots().front().second;
    Renderer first = next_run(), second = next_run();
    EXPECT_FALSE(picture(first, shot).stats.splats_read);
    EXPECT_FALSE(picture(second, shot).stats.splats_read);
}

TEST_F(KeptBetweenRuns, OfDamagedBytesAreNotTaken) {
    CollectionPlan plan;
    plan.dims = glm::ivec3(8);
    plan.faces = true;
    KeptSplats kept{
        .splats = 3, .high = glm::ivec3(7), .bricks = {{{glm::ivec3(0), glm::ivec3(7)}, 0, 3}}, .lists = {}};
    for (const std::size_t bytes : {12U, 8U, 0U, 0U})
        kept.lists.emplace_back(3 * bytes, std::uint8_t{7});
    const std::string key = "the key";
    const std::vector<std::uint8_t> bytes = pack(kept, key);
    ASSERT_TRUE(unpack_splats(bytes, key, plan));
    EXPECT_EQ(unpack_splats(bytes, key, plan)->lists, kept.lists);
    EXPECT_FALSE(unpack_splats(bytes, "the kez", plan));
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_FALSE(unpack_splats({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}, key, plan));
    std::vector<std::uint8_t> longer = bytes;
    longer.push_back(0);
    EXPECT_FALSE(unpack_splats(longer, key, plan));
    const auto expect_refused = [&](KeptSplats damaged, const char* what) {
        EXPECT_FALSE(unpack_splats(pack(damaged, key), key, plan)) << what;
    };
    KeptSplats damaged = kept;
    damaged.splats = std::uint64_t{1} << 62U;
    expect_refused(damaged, "number of splats");
    damaged = kept;
    damaged.bricks.front().first = 1;
    expect_refused(damaged, "beginning of a brick");
    damaged = kept;
    damaged.bricks.front().box.high.y = 8;
    expect_refused(damaged, "box of a brick");
    damaged = kept;
    damaged.high.z = 8;
    expect_refused(damaged, "box of the list");
    damaged = kept;
    damaged.lists.front().pop_back();
    expect_refused(damaged, "length of a list");
}

TEST_F(KeptBetweenRuns, ReadLongestAgoMakeRoom) {
    CollectionPlan plan;
    plan.dims = glm::ivec3(4);
    plan.edge_field = false;
    KeptSplats kept{
        .splats = 100, .high = glm::ivec3(3), .bricks = {{{glm::ivec3(0), glm::ivec3(3)}, 0, 100}}, .lists = {}};
    kept.lists = {std::vector<std::uint8_t>(1200), {}, {}, {}};
    const std::uint64_t room = 3 * (pack(kept, "a").size() + 100);
    for (const char* key : {"a", "b", "c"}) {
        ASSERT_TRUE(keep_splats(splats(), key, kept, room));
        ::usleep(20000);  // files' times are not finer than the system's clock tick
    }
    EXPECT_TRUE(read_splats(splats(), "a", plan));
    ASSERT_TRUE(keep_splats(splats(), "d", kept, room));
    EXPECT_TRUE(read_splats(splats(), "a", plan));
    EXPECT_FALSE(read_splats(splats(), "b", plan)) << "read longest ago";
    EXPECT_TRUE(read_splats(splats(), "c", plan));
    EXPECT_TRUE(read_splats(splats(), "d", plan));
    EXPECT_FALSE(keep_splats(splats(), "e", kept, 100)) << "larger than all room";
    EXPECT_EQ(files().size(), 3U);
}

}  // namespace
}  // namespace edgesplat::test
