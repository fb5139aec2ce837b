// Describes a picture's passes and resources, with the reason for each, and the cost of effects that are off.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/forecast/effect_table.h"
#include "engine/gpu/pipelines.h"
#include "engine/renderer.h"

namespace edgesplat {

/// A pass of a draw; all sheet groups together are one entry.
struct PassDescription {
    std::string draw;      ///< "setup", "colour", or the extra output that this draw is for
    std::string name;      ///< stem, e.g. "5_draw_splats"
    std::string reason{};  ///< effects that need the pass
    std::vector<gpu::PipelineVariant> pipelines{};
    std::optional<double> measured_milliseconds{};
    bool depends = false;  ///< may be skipped once splats are known; then removed from a measured frame
};

/// Shaders with their specialization constants: "7_resolve.comp PAYLOAD=0".
std::string text_of(const gpu::PipelineVariant& pipeline);

/// An image or a buffer.
struct ResourceDescription {
    std::string name, shape, format, contents, written, read, reason;
    std::uint64_t bytes = 0;                       ///< of its texels or elements
    std::optional<std::uint64_t> device_bytes;     ///< rounded up by the device; nullopt without a device
    std::optional<std::uint64_t> allocated_bytes;  ///< allocated under this name in a measured frame
    std::string held;                              ///< lifetime: "always", "while drawing", "while uploading", ...
    bool transient() const { return held != "always" && held != "while drawing"; }
};

/// A field of every splat's record.
struct RecordDescription {
    std::string name, reason;
    std::uint32_t bytes = 0;
};

/// An effect that is off in the picture.
struct LeftOut {
    std::string effect, call;         ///< its name, and how to enable it
    std::vector<std::string> passes;  ///< additional passes with the effect
    std::int64_t bytes = 0;           ///< additional memory with the effect
    std::string obstacle;             ///< why it cannot be enabled; empty if it can
};

struct FrameDescription {
    std::string volume;                   ///< name and dims
    std::string device;                   ///< empty: without a device
    std::string profile, profile_reason;  ///< device profile and the reason for its choice
    glm::ivec2 size{0};
    std::uint64_t voxels = 0, splats = 0;
    std::string splats_from;  ///< "counted on the host" or "as collected"
    std::uint32_t sheets = 0, sheet_groups = 0;
    std::vector<PassDescription> passes;  ///< in execution order
    std::vector<ResourceDescription> resources;
    std::vector<std::pair<std::string, std::uint64_t>> volumes;  ///< of several: their names and bytes of `resources`
    std::vector<RecordDescription> record;
    std::vector<std::pair<std::string, std::string>> active_effects;  ///< (effect, reason)
    std::vector<LeftOut> left_out;

    /// Peak memory: permanent resources plus the largest sum of temporary ones of the same lifetime, bytes.
    std::uint64_t total_bytes() const;
};

/// A change that makes a request fit into memory.
struct FittingChange {
    std::string text;  ///< "--size 320x240"
    FrameRequest request;
};

/// Describes a frame without a device: bytes from the formats. `profile`: as in
/// DeviceChoice. Throws Error for a request that cannot be drawn.
FrameDescription describe_frame(const FrameRequest& request, const std::string& profile = {});

/// The same for a renderer, its device and its splats. With the frame's statistics `measured` also the measured times
/// of passes and the allocated bytes.
FrameDescription describe_frame(const FrameRequest& request, Renderer& renderer, const RenderStats* measured = nullptr);

/// The description as tables with aligned columns.
std::string to_text(const FrameDescription& description);

}  // namespace edgesplat
