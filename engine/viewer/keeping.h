// What is kept of a session: its scene, and pictures of it at any size.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "engine/renderer.h"
#include "engine/scene/scene_document.h"

namespace edgesplat::viewer {

/// Writes a scene file, whole or not at all. A volume's relative path is kept so that it leads there from the file's
/// folder. Throws Error.
void save_scene(SceneDocument document, const Volume& volume, const std::filesystem::path& path);

/// A picture to be made in the background.
struct PictureOrder {
    std::shared_ptr<const Volume> volume;
    SceneDocument document;  ///< with nothing left open (`resolved`); output.size is the picture's
    DeviceChoice device;
    std::filesystem::path path;  ///< .png or .exr
    std::string program;         ///< name and version, for the picture's metadata
};

/// Renders it offscreen and writes it with its metadata. Throws Error.
void save_picture(const PictureOrder& order);

/// A path that stands for nothing yet, and is not `taken` either: folder/stem-1.extension, -2, ...
std::filesystem::path free_path(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& extension,
                                const std::function<bool(const std::filesystem::path&)>& taken = {});

}  // namespace edgesplat::viewer
