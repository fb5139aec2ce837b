// Labels of a segmentation in the output of commands.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "engine/scene/effects.h"
#include "engine/scene/scene_document.h"
#include "engine/volume/volume.h"

/// Describes a volume's labels: sets "labels", a list with number, name, colour (linear light) and voxels. If samples
/// are ranks, "range", "mean", "histogram" and "suggested_iso_values" become those of the numbers. No-op for other
/// volumes.
void add_labels(nlohmann::json& json, const edgesplat::Volume& volume);

/// The labels that are shown, measured inside the clip planes: "labels", with number, name, voxels and volume; those of
/// a scan with the mean and the standard deviation of its values. `source` chooses among the labels of a scan.
nlohmann::ordered_json labels_measured(const edgesplat::Volume& volume, const edgesplat::Clip& clip,
                                       const edgesplat::VolumeSource& source);

/// Number and name of the label at a place of the world (mm) in a volume of drawn labels; null beside all labels.
nlohmann::ordered_json described_label_at(const edgesplat::Volume& volume, const glm::dvec3& world);

/// Prints "labels" of add_labels(), the largest 40 of them.
void print_labels(const nlohmann::json& json);
