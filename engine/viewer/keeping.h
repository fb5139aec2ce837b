// Saves a session: its scene, and pictures of it at any size.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "engine/renderer.h"
#include "engine/scene/scene_document.h"

namespace edgesplat::viewer {

/// Writes a scene file, completely or not at all. A volume's relative path is rewritten relative to the file's folder.
/// Throws Error.
void save_scene(SceneDocument document, const Volume& volume, const std::filesystem::path& path);

/// A request to render a picture in the background.
struct PictureJob {
    std::shared_ptr<const Volume> volume;
    SceneDocument document;  ///< resolved: every key has a value; output.size is the picture's size
    DeviceChoice device;
    std::filesystem::path path;  ///< .png or .exr
    std::string program;         ///< name and version, for the picture's metadata
};

/// Renders the picture offscreen and writes it with its metadata. Throws Error.
void save_picture(const PictureJob& order);

/// The first path of folder/stem-1.extension, -2, ... that does not exist and is not `taken`.
std::filesystem::path free_path(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& extension,
                                const std::function<bool(const std::filesystem::path&)>& taken = {});

}  // namespace edgesplat::viewer
