// The cache of compiled pipelines on disk: read if intact, ignored if damaged, and not required.
#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include "engine/forecast/description_passes.h"
#include "engine/gpu/pipelines.h"
#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

namespace fs = std::filesystem;

struct Folder {
    Folder() { fs::create_directories(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path); }
    fs::path path = fs::path(testing::TempDir()) / ("pipeline_cache_" + std::to_string(::getpid()));
};

/// Starts with the folder's cache and compiles a pipeline. Returns the number of bytes read.
std::size_t start(const fs::path& folder) {
    gpu::Pipelines pipelines(device_under_test().device(), folder);
    EXPECT_TRUE(pipelines.compute("7_resolve.comp", {}));
    EXPECT_EQ(pipelines.creation().count, 1U);
    return pipelines.cache().loaded_bytes();
}

fs::path only_file(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        files.push_back(entry.path());
    EXPECT_EQ(files.size(), 1U) << "no temporary file remains";
    return files.empty() ? fs::path() : files.front();
}

TEST(PipelineCache, IsReadByTheNextStart) {
    const Folder folder;
    EXPECT_EQ(start(folder.path), 0U);
    EXPECT_EQ(start(folder.path) + 24, fs::file_size(only_file(folder.path)));
}

TEST(PipelineCache, IsIgnoredIfDamaged) {
    const Folder folder;
    start(folder.path);
    const fs::path file = only_file(folder.path);
    const auto whole = fs::file_size(file);
    {
        std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
        out.seekp(static_cast<std::streamoff>(whole - 1));
        out.put('x').put('y');
    }
    EXPECT_EQ(start(folder.path), 0U) << "longer";
    fs::resize_file(file, whole - 4);
    EXPECT_EQ(start(folder.path), 0U) << "shorter";
    fs::resize_file(file, 10);
    EXPECT_EQ(start(folder.path), 0U) << "without a header";
    EXPECT_GT(start(folder.path), 0U) << "and rewritten each time";
}

TEST(PipelineCache, IsOptional) {
    EXPECT_EQ(start({}), 0U) << "no folder";
    const Folder folder;
    const fs::path file = folder.path / "file";
    std::ofstream(file) << "not a folder";
    EXPECT_EQ(start(file), 0U);
    EXPECT_EQ(only_file(folder.path), file);
}

TEST(Pipelines, AreCreatedAheadOnce) {
    gpu::Pipelines pipelines(device_under_test().device(), {});
    const gpu::Specialization gradient{{shader::SPEC_GRADIENT, 1}};
    pipelines.create_ahead({{{"7_resolve.comp"}, {}}, {{"7_resolve.comp"}, gradient}, {{"7_resolve.comp"}, {}}});
    const vk::Pipeline first = pipelines.compute("7_resolve.comp", gradient);
    EXPECT_EQ(pipelines.creation().count, 1U) << "only used ones are counted";
    EXPECT_EQ(pipelines.used().size(), 1U);
    EXPECT_NE(pipelines.compute("7_resolve.comp", {}), first);
    EXPECT_EQ(pipelines.compute("7_resolve.comp", gradient), first);
    EXPECT_EQ(pipelines.creation().count, 2U);
}

TEST(Pipelines, ErrorsOfCreationAheadAreThrownWhenUsed) {
    gpu::Pipelines pipelines(device_under_test().device(), {});
    pipelines.create_ahead({{{"no_such_shader.comp"}, {}}, {{"7_resolve.comp"}, {}}});
    EXPECT_TRUE(pipelines.compute("7_resolve.comp", {}));
    EXPECT_THROW(pipelines.compute("no_such_shader.comp", {}), std::logic_error);
}

/// A picture of surface splats creates no pipeline ahead that it does not use, and nearly all that it uses. (With
/// kernels, some depend on whether a splat has a crease.)
TEST(Pipelines, AheadAreThoseOfThePicture) {
    DeviceUnderTest& state = device_under_test();
    for (const char* effect : {"none", "outlines", "occlusion", "shadows", "clip"}) {
        SCOPED_TRACE(effect);
        const std::string_view name = effect;
        PassScene s = pass_scenes().front();
        s.settings.opaque = OpaqueMatter::Surfaces;
        s.scene.effects.smooth_outlines = name == "outlines";
        if (name == "occlusion") s.scene.effects.occlusion.emplace();
        if (name == "shadows") s.scene.lights.front().shadows = true;
        if (name == "clip") s.scene.effects.clip.keep = {{s.volume.geometry.center(), {1, 0, 0}}};
        const FrameRequest request{std::make_shared<Volume>(s.volume), s.scene, s.camera, s.settings, {40, 40}, {}};
        const Settings settings = drawn_settings(request);
        ASSERT_TRUE(draws_surfaces(settings, s.scene, s.volume));
        state.level = LevelStore(state.session);
        state.session.pipelines().forget_used();
        state.level.volume.hold(request.volume, 0);
        state.collect(request.scene, settings, keeps_buried(request));
        state.draw(request.scene, request.camera, settings, request.size, shader::PAYLOAD_COLOR);
        std::set<std::string> used, ahead;
        for (const gpu::PipelineVariant& variant : state.session.pipelines().used())
            used.insert(edgesplat::text_of(variant));
        const FrameForecast forecast = forecast_frame(request, most_splats_of, state.device().profile());
        for (const gpu::PipelineVariant& variant : pipelines_of(request, forecast))
            ahead.insert(edgesplat::text_of(variant));
        std::vector<std::string> unused;
        std::ranges::set_difference(ahead, used, std::back_inserter(unused));
        EXPECT_THAT(unused, testing::IsEmpty());
        EXPECT_GE(ahead.size() + 2, used.size());
    }
}

}  // namespace
}  // namespace edgesplat::test
