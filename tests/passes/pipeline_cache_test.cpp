// The cache of compiled pipelines on disk: read if intact, ignored if damaged, and not required.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "engine/gpu/pipelines.h"
#include "tests/passes/device_under_test.h"

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

}  // namespace
}  // namespace edgesplat::test
