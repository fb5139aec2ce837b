// The number of clip planes that a pass tests.
#pragma once

#include <cstdint>

namespace edgesplat::passes {

/// Numbers of clip planes in SceneParams and FrameParams. They are specialization constants of the passes that test
/// planes; with 0 planes a shader has no clipping code.
struct ClipCount {
    std::uint32_t keep = 0, remove = 0;
    bool any() const { return keep + remove > 0; }
    bool operator==(const ClipCount&) const = default;
};

}  // namespace edgesplat::passes
