// The table of extra outputs (AOVs). Scenes, programs, frames and files read their rows from it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat {

/// The requested extra outputs of a frame; none by default.
struct AovRequest {
    bool tau = false;    ///< optical depth along the pixel's ray, 1 channel; without saturation, buried voxels included
    bool depth = false;  ///< mean distance along the view axis, mm, 1 channel; 0 where nothing is hit
    bool normal = false;    ///< mean world normal of the visible matter, 3 channels, unit length or 0
    bool distance = false;  ///< mean signed distance of the visible voxels to their edge, voxels, 1 channel
};

struct Aov {
    std::string_view name;  ///< name in scenes and on the command line
    std::string_view help;  ///< description in one line
    bool AovRequest::*wanted;
    std::uint32_t payload;  ///< shader::PAYLOAD_* of the draw that computes it; outputs may share a payload
    int first;              ///< its first channel in that draw's picture
    std::array<const char*, 3> channels;  ///< channel names in an .exr; null beyond the last
    int count() const { return channels[1] == nullptr ? 1 : channels[2] == nullptr ? 2 : 3; }
};

inline constexpr std::size_t kAovCount = 4;
std::span<const Aov, kAovCount> aovs();

std::vector<std::string> aov_names();

/// The request for these names; unknown names are ignored.
AovRequest aov_request(std::span<const std::string> names);

/// The payloads (shader::PAYLOAD_*) that a request needs, colour first.
std::vector<std::uint32_t> payloads_of(const AovRequest& outputs);

/// "colour", or the names of the outputs that this payload computes.
std::string payload_name(std::uint32_t payload);

}  // namespace edgesplat
