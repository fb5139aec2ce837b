#include "engine/accuracy/analytic_truth.h"

namespace edgesplat::accuracy {

std::optional<AnalyticScene> analytic_scene_of(std::string_view path) {
    if (!is_builtin(path)) return {};
    const std::string_view name = path.substr(path.find(':') + 1);
    const AnalyticScene scene = analytic_scene(name.substr(0, name.find(':')));
    // The grid is read where it is written down, so that no one else has to understand the path.
    const glm::ivec3 dims = builtin_volume(path).geometry.dims;
    return dims == scene.dims ? scene : resized(scene, dims);
}

}  // namespace edgesplat::accuracy
