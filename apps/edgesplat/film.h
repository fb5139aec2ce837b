// A movie: the scene and the camera at each time, from which the frames are drawn.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "engine/renderer.h"
#include "engine/scene/camera_path.h"
#include "engine/scene/cuts.h"
#include "engine/scene/scene_document.h"

struct Film {
    edgesplat::SceneDocument document;
    std::vector<std::filesystem::path> folders;              ///< where the volume is searched
    edgesplat::VolumeSource source;                          ///< of the film's volume; changes if it is animated
    std::shared_ptr<const edgesplat::Volume> whole, volume;  ///< before and after others cut it
    edgesplat::Cuts cuts;
    edgesplat::CameraPath path;
    std::vector<edgesplat::AnimatedParameter> animation;
    edgesplat::Settings settings;
    double fps = 25;
    int count = 0;  ///< frames

    /// Time of a frame on the time axis of the path's keys, s.
    double time_of(int frame) const { return path.keys.front().time + frame / fps; }
};

/// Checks, before the volume is read, that outputs and renderer suit a movie. Throws edgesplat::Error.
void check_film(const edgesplat::SceneDocument& document);

/// Sets the keys of the volume that are animated, such as volume.frame, to their first values. Call it before the
/// volume is read. Throws edgesplat::Error.
void start_volume(edgesplat::SceneDocument& document);

/// Resolves a document to a movie. `volume` was read for it from `folders`. `seconds`: its duration; nullopt: until the
/// camera path and all animations end. Throws edgesplat::Error.
Film film_of(edgesplat::SceneDocument document, const std::vector<std::filesystem::path>& folders,
             std::shared_ptr<const edgesplat::Volume> volume, std::optional<double> seconds);

/// The scene at `time` (s): the document with the animated values of that time.
edgesplat::Scene scene_at(const Film& film, double time);

/// Draws one frame. The renderer must hold the film's volume; if the frame shows another one, it is read and replaces
/// that. Throws edgesplat::Error.
edgesplat::RenderResult draw_frame(Film& film, edgesplat::Renderer& renderer, int frame);
