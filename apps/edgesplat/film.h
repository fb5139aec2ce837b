// A movie as what each of its frames is made from: the scene and its camera at a time.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/renderer.h"
#include "engine/scene/camera_path.h"
#include "engine/scene/scene_document.h"

struct Film {
    edgesplat::SceneDocument document;
    std::shared_ptr<const edgesplat::Volume> volume;
    edgesplat::CameraPath path;
    std::vector<edgesplat::AnimatedParameter> animation;
    edgesplat::Settings settings;
    double fps = 25;
    int count = 0;  ///< frames

    /// Seconds, as the path's keys have them.
    double time_of(int frame) const { return path.keys.front().time + frame / fps; }
};

/// Refuses, before the volume is read, outputs and renderers that no movie has. Throws edgesplat::Error.
void check_film(const edgesplat::SceneDocument& document);

/// `seconds`: how long; not given: until the camera's way and all animated numbers end. Throws edgesplat::Error.
Film film_of(edgesplat::SceneDocument document, std::shared_ptr<const edgesplat::Volume> volume,
             std::optional<double> seconds);

/// The scene at a time: the document with its animated numbers set.
edgesplat::Scene scene_at(const Film& film, double time);

/// One frame by the film's renderer; its volume must be set. Throws edgesplat::Error.
edgesplat::RenderResult draw_frame(const Film& film, edgesplat::Renderer& renderer, int frame);
