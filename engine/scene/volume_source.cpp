// Finds, loads and preprocesses a scene's volume.
#include <cstdlib>
#include <sstream>

#include "engine/error.h"
#include "engine/scene/scene_document.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/filters.h"
#include "engine/volume/labels.h"
#include "engine/volume/load_volume.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

/// Whether the path can be opened; for a pattern of slices ("slice_%03d.tif", "*.dcm") only its folder is checked.
bool may_be_opened(const fs::path& path) {
    std::error_code ignored;
    if (fs::exists(split_inner(path.string()).file, ignored)) return true;
    const bool pattern = path.filename().string().find_first_of("%*?") != std::string::npos;
    return pattern && fs::is_directory(path.has_parent_path() ? path.parent_path() : fs::path("."), ignored);
}

}  // namespace

std::vector<fs::path> volume_folders(const fs::path& first) {
    std::vector<fs::path> folders{first};
    if (const char* text = std::getenv("EDGESPLAT_VOLUMES")) {
        std::istringstream in(text);
        for (std::string folder; std::getline(in, folder, ':');)
            if (!folder.empty()) folders.emplace_back(folder);
    }
    return folders;
}

std::string find_volume(const std::string& path, const std::vector<fs::path>& folders) {
    if (is_builtin(path)) return path;
    if (fs::path(path).extension() == ".toml")
        fail("{}: is a scene file; expected a volume: a file, a folder, a pattern of slices or builtin:NAME", path);
    std::string places;
    for (const fs::path& folder : folders) {
        // For an absolute path, folder / path is path.
        const fs::path candidate = folder / path;
        if (may_be_opened(candidate)) return candidate.string();
        if (fs::path(path).is_absolute()) break;
        places += fmt::format("{}{}", places.empty() ? "" : ", ", folder.empty() ? "." : folder.string());
    }
    if (places.empty()) fail("{}: no such file or folder", path);
    fail("{}: no such file or folder in {}; the environment variable EDGESPLAT_VOLUMES can name more folders", path,
         places);
}

Volume load_source(const VolumeSource& source, const std::vector<fs::path>& folders,
                   const std::function<void(double fraction, std::string_view what)>& progress) {
    LoadOptions options;
    options.component = source.component;
    options.frame = source.frame;
    options.level = source.level;
    options.series = source.series;
    options.raw = source.raw;
    options.spacing = source.spacing;
    options.no_data = source.no_data;
    options.resample = source.resample;
    options.progress = progress;
    const std::string path = find_volume(source.path, folders);
    return preprocessed(load_volume(path, options), source);
}

Volume preprocessed(Volume volume, const VolumeSource& source) {
    const auto warnings = volume.warnings;
    if (source.threshold) volume = threshold(volume, *source.threshold / volume.value_scale);
    if (source.labels.value_or(false)) volume = drawn_labels(volume);
    if (source.box_filter) volume = box_filter(volume);
    if (source.crop_low || source.crop_high)
        volume = cropped(volume, source.crop_low.value_or(glm::ivec3(0)),
                         source.crop_high.value_or(volume.geometry.dims - 1));
    volume.warnings = warnings;
    const std::string checksum = fmt::format("{:016x}", volume.checksum);
    if (!source.checksum.empty() && source.checksum != checksum)
        fail("{}: its samples have the checksum {}, but the scene was made for {} (volume.checksum)", volume.name,
             checksum, source.checksum);
    return volume;
}

void recognise_labels(SceneDocument& document, Volume& volume) {
    constexpr std::size_t kFewest = 3;  // two labels are a mask, which has one surface
    const VolumeSource& source = document.volume;
    const bool open = document.iso_values.empty() && document.iso_sigmas.empty() && document.materials.empty() &&
                      document.transfer.empty() && document.transfer_preset.empty() && !source.threshold &&
                      !source.box_filter && !source.labels && !document.quality.max_error;
    const bool splats = document.output.renderer == RendererKind::Splat && !document.output.compare_raycast;
    if (!open || !splats || volume.packed || is_builtin(volume.name)) return;
    const std::size_t count = labels_of(volume).size();
    if (count < kFewest || count > kMaxDrawnLabels + 1) return;
    volume = drawn_labels(volume);
    document.volume.labels = true;
    if (!document.volume.checksum.empty()) document.volume.checksum = fmt::format("{:016x}", volume.checksum);
}

}  // namespace edgesplat
