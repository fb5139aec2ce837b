// What a picture will run and hold, with the reason for every line; and what it does not, with the price of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/forecast/effect_table.h"
#include "engine/renderer.h"

namespace edgesplat {

/// A pass, once: a draw's sheet groups together.
struct PassDescription {
    std::string draw;                   ///< "setup", "colour", or the extra output that the frame is drawn again for
    std::string name;                   ///< stem, e.g. "5_draw_splats"
    std::string reason;                 ///< what calls for it
    std::vector<std::string> variants;  ///< shaders with their specialization constants: "7_resolve.comp PAYLOAD=0"
    double estimated_milliseconds = 0;  ///< on the kind of device that is described; see `estimate`
    std::optional<double> measured_milliseconds;
    bool depends =
        false;  ///< whether it runs is seen once splats are sorted; left out of a measured frame that did not
};

/// An image or a buffer.
struct ResourceDescription {
    std::string name, shape, format, contents, written, read, reason;
    std::uint64_t bytes = 0;                       ///< of its texels or elements
    std::optional<std::uint64_t> device_bytes;     ///< as the device rounds them up; of a device only
    std::optional<std::uint64_t> allocated_bytes;  ///< what was held under this name in the frame described
    std::string held;                              ///< "always", "while drawing", "while uploading", ...
    bool transient() const { return held != "always" && held != "while drawing"; }
};

/// A field that every splat carries.
struct RecordDescription {
    std::string name, reason;
    std::uint32_t bytes = 0;
};

/// An effect that the picture does without.
struct LeftOut {
    std::string effect, call;         ///< its name, and how to call for it
    std::vector<std::string> passes;  ///< that would run as well
    std::int64_t bytes = 0;           ///< that would be held more
    std::string obstacle;             ///< why it cannot be had here; empty: it can
};

struct FrameDescription {
    std::string volume;                   ///< name and dims
    std::string device;                   ///< empty: of no device
    std::string profile, profile_reason;  ///< how frames are made on it, and why so; likewise
    glm::ivec2 size{0};
    std::uint64_t voxels = 0, splats = 0;
    std::string splats_from;  ///< "counted on the host" or "as collected"
    std::uint32_t sheets = 0, sheet_groups = 0;
    std::vector<PassDescription> passes;  ///< in the order they run in
    std::vector<ResourceDescription> resources;
    std::vector<RecordDescription> record;
    std::vector<std::pair<std::string, std::string>> called_for;  ///< effects and why
    std::vector<LeftOut> left_out;
    std::string estimate;  ///< what the estimated times are based on

    /// Bytes held at most at once: what is held always, and the most of what is held for a time.
    std::uint64_t total_bytes() const;
};

/// A change to a request that makes it fit.
struct FittingChange {
    std::string text;  ///< "--size 320x240"
    FrameRequest request;
};

/// Of no device: bytes as the formats say, times of a software device. `profile`: as in DeviceChoice. Throws Error for
/// a request that cannot be drawn.
FrameDescription describe_frame(const FrameRequest& request, const std::string& profile = {});

/// The same for what a renderer holds and the device that it uses; with the frame's own statistics also what passes
/// took and what was allocated.
FrameDescription describe_frame(const FrameRequest& request, Renderer& renderer, const RenderStats* measured = nullptr);

/// Aligned columns, a line each.
std::string to_text(const FrameDescription& description);

}  // namespace edgesplat
