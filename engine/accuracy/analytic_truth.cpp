#include "engine/accuracy/analytic_truth.h"

namespace edgesplat::accuracy {

std::optional<AnalyticScene> analytic_scene_of(std::string_view path) {
    if (!is_builtin(path)) return {};
    return builtin_scene(path);
}

std::optional<AnalyticScene> analytic_scene_of(const VolumeSource& source) {
    if (source.threshold || source.box_filter || source.crop_low) return {};
    return analytic_scene_of(source.path);
}

}  // namespace edgesplat::accuracy
