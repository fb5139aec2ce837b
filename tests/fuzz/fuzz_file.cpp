#include "tests/fuzz/fuzz_file.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "engine/error.h"
#include "engine/volume/load_volume.h"

namespace edgesplat::fuzz {
namespace {

namespace fs = std::filesystem;

struct Folder {
    Folder() {
        std::error_code ignored;
        const fs::path memory = "/dev/shm";
        if (access(memory.c_str(), W_OK) == 0) setenv("TMPDIR", memory.c_str(), 1);
        std::string name = (fs::temp_directory_path(ignored) / "edgesplat-fuzz-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) std::abort();
        path = name;
        setenv("EDGESPLAT_READ_MEMORY", "256", 1);
        // The user's own presets must not affect the fuzzers.
        setenv("XDG_CONFIG_HOME", path.c_str(), 1);
        unsetenv("EDGESPLAT_PRESETS");
        unsetenv("EDGESPLAT_VOLUMES");
    }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    fs::path path;
};

}  // namespace

const fs::path& folder() {
    static const Folder only;
    return only.path;
}

std::string write(const std::string& name, std::string_view content) {
    const fs::path path = folder() / name;
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    return path.string();
}

std::string load(const std::string& name, std::string_view content) {
    const std::string path = write(name, content);
    try {
        const Volume volume = load_volume(path, {.component = 0, .frame = 0});
        if (volume.values.size() != volume.geometry.voxel_count()) std::abort();
    } catch (const Error&) {
    }
    return path;
}

}  // namespace edgesplat::fuzz
