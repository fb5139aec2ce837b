// Extra outputs of a picture, a row each: what scenes, programs, frames and files know of them comes from it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat {

/// Extra outputs of a frame. None is made unless asked for.
struct AovRequest {
    bool tau = false;       ///< optical depth along the pixel's ray, 1 channel, unsaturated, nothing buried dropped
    bool depth = false;     ///< mean distance along the view axis, mm, 1 channel; 0 where nothing is hit
    bool normal = false;    ///< mean world normal of what is seen, 3 channels, unit length or 0
    bool distance = false;  ///< mean signed distance of the seen voxels to their edge, voxels, 1 channel
};

struct Aov {
    std::string_view name;  ///< in scenes and on the command line
    std::string_view help;  ///< what it shows, in one line
    bool AovRequest::*wanted;
    std::uint32_t payload;  ///< shader::PAYLOAD_*: what a draw sums for it, and for others of that payload
    int first;              ///< of its channels in that draw's picture
    std::array<const char*, 3> channels;  ///< their names in an .exr; null beyond the last
    int count() const { return channels[1] == nullptr ? 1 : channels[2] == nullptr ? 2 : 3; }
};

inline constexpr std::size_t kAovCount = 4;
std::span<const Aov, kAovCount> aovs();

std::vector<std::string> aov_names();

/// Those of the names; others are left out.
AovRequest aov_request(std::span<const std::string> names);

/// The payloads that a request draws, colour first: shader::PAYLOAD_*.
std::vector<std::uint32_t> payloads_of(const AovRequest& outputs);

/// "colour", or the names of the outputs that a draw is for.
std::string payload_name(std::uint32_t payload);

}  // namespace edgesplat
