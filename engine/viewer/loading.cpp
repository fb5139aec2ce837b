#include "engine/viewer/loading.h"

#include <chrono>
#include <utility>

#include "engine/scene/scene_file.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/labels.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat::viewer {

Opened open_path(const std::string& path, const std::function<void(double fraction, std::string_view what)>& progress) {
    Opened out;
    out.path = path;
    if (is_scene_path(path)) {
        out.document = read_scene_file(path);
        out.folders = volume_folders(std::filesystem::path(path).parent_path());
    } else {
        out.document.volume.path = path;
        out.folders = volume_folders({});
    }
    const auto settle = [&](VolumeSource& source) {
        for (std::string* file : source.other_files())
            if (!file->empty()) *file = std::filesystem::absolute(find_file(*file, out.folders)).string();
    };
    settle(out.document.volume);
    for (SceneDocument& entry : out.document.volumes) {
        std::string& of_entry = entry.volume.path;
        if (!is_builtin(of_entry)) of_entry = std::filesystem::absolute(find_volume(of_entry, out.folders)).string();
        settle(entry.volume);
    }
    Volume volume = small_labels_in_memory(read_source(out.document.volume, out.folders, progress));
    if (labels_of(volume) && !volume.packed) out.samples = std::make_shared<const Volume>(volume);
    out.whole = std::make_shared<const Volume>(prepared_volume(out.document, std::move(volume)));
    read_volumes(out.document, out.folders, progress, out.samples.get());
    out.volume = out.cuts.apply(out.document, out.whole);
    return out;
}

Loading::Loading(std::string path) : path_(std::move(path)) {
    result_ = std::async(std::launch::async, [this] {
        return open_path(path_, [this](double fraction, std::string_view what) {
            fraction_ = fraction;
            const std::lock_guard lock(mutex_);
            what_ = what;
        });
    });
}

std::string Loading::what() const {
    const std::lock_guard lock(mutex_);
    return what_;
}

bool Loading::ready() const {
    return result_.valid() && result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace edgesplat::viewer
