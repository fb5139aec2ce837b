// How many clip planes a pass looks at.
#pragma once

#include <cstdint>

namespace edgesplat::passes {

/// Planes that SceneParams and FrameParams hold, each a specialization constant of the passes that look at them.
/// Without planes nothing of the clip is left in a shader.
struct ClipCount {
    std::uint32_t keep = 0, remove = 0;
    bool any() const { return keep + remove > 0; }
    bool operator==(const ClipCount&) const = default;
};

}  // namespace edgesplat::passes
