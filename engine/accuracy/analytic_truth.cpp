#include "engine/accuracy/analytic_truth.h"

namespace edgesplat::accuracy {

std::optional<AnalyticScene> analytic_scene_of(std::string_view path) {
    if (!is_builtin(path)) return {};
    return builtin_scene(path);
}

}  // namespace edgesplat::accuracy
