// Output files of a rendering: picture, extra outputs, statistics. All of them are written, or none.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/image_file.h"
#include "engine/renderer.h"

/// One picture of the run: `--compare` makes two or three.
struct RenderedFrame {
    std::string name;  ///< "plain", "raycast" or "edges"
    edgesplat::Settings settings;
    edgesplat::RenderResult result;
    bool rays = false;  ///< ray cast, not splatted
};

/// Description of the run for statistics and metadata.
struct RunDescription {
    std::string command_line;
    const edgesplat::Volume* volume = nullptr;
    const edgesplat::Scene* scene = nullptr;
    edgesplat::Camera camera;
    std::string volume_path;      ///< as the picture records it
    std::string scene_text;       ///< TOML that reproduces the picture
    std::string device;           ///< name and driver
    nlohmann::ordered_json plan;  ///< of the last frame; null unless requested
};

/// Metadata of every picture: program version, command, volume and its checksum, device, and the scene.
edgesplat::ImageMetadata picture_metadata(const RunDescription& run);

/// The statistics that `--json` writes: run, volume, scene, camera, device, and per frame the settings, counts, memory,
/// and milliseconds per pass.
nlohmann::ordered_json statistics(const RunDescription& run, const std::vector<RenderedFrame>& frames);

/// Path of the extra output `aov` of a .png: "out.png" -> "out.tau.exr".
std::filesystem::path aov_path(const std::filesystem::path& picture, const std::string& aov);

/// Encodes the frames as one picture, several side by side with dividers, and the extra outputs of the last frame. An
/// .exr holds all of them (R,G,B,A, tau, depth.Z, normal.X/Y/Z, distance). A .png holds R,G,B over the background;
/// extra outputs go to separate files (`aov_path`).
std::vector<edgesplat::FileContent> picture_files(const std::filesystem::path& path,
                                                  const std::vector<RenderedFrame>& frames,
                                                  const edgesplat::ImageMetadata& metadata);
