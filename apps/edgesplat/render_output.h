// The files a render leaves: picture, extra outputs, statistics. All of them appear, or none.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/edgesplat/mpi_report.h"
#include "engine/image/image_file.h"
#include "engine/renderer.h"

/// One picture of the run: `--compare` makes two or three.
struct RenderedFrame {
    std::string name;  ///< "plain", "raycast" or "edges"
    edgesplat::Settings settings;
    edgesplat::RenderResult result;
    std::vector<RankReport> ranks{};  ///< where its sheets were divided
    bool rays = false;                ///< cast, not splatted
};

/// What the statistics and the metadata say about the run.
struct RunDescription {
    std::string command_line;
    const edgesplat::Volume* volume = nullptr;
    const edgesplat::Scene* scene = nullptr;
    edgesplat::Camera camera;
    std::string volume_path;      ///< from where the picture is looked at
    std::string scene_text;       ///< TOML from which the picture can be made again
    std::string device;           ///< what it was made on
    nlohmann::ordered_json plan;  ///< of the last frame, where it was asked for
};

/// Command, program version, device, volume and its checksum, and the scene itself, as they go into every picture.
edgesplat::ImageMetadata picture_metadata(const RunDescription& run);

/// Everything measured, as `--json` writes it: run, volume, scene, camera, device, and per frame the settings, counts,
/// memory, and milliseconds per pass.
nlohmann::ordered_json statistics(const RunDescription& run, const std::vector<RenderedFrame>& frames);

/// Where the extra output `aov` of a .png goes: "out.png" -> "out.tau.exr".
std::filesystem::path aov_path(const std::filesystem::path& picture, const std::string& aov);

/// The picture of the frames, side by side with dividers where there are several, with the extra outputs of the last
/// one: inside an .exr (R,G,B,A, tau, depth.Z, normal.X/Y/Z, distance), in files of their own (`aov_path`) beside a
/// .png, which holds R,G,B over the background.
std::vector<edgesplat::FileContent> picture_files(const std::filesystem::path& path,
                                                  const std::vector<RenderedFrame>& frames,
                                                  const edgesplat::ImageMetadata& metadata);
