// The table of effects: how each is enabled and what it adds to a frame. The frame's description, the `effects` command
// and the tests that a disabled effect costs nothing read it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/frame_request.h"

namespace edgesplat {

/// A specialization constant and its value in a frame without the effect.
struct EffectConstant {
    std::uint32_t id;       ///< shader::SPEC_*
    std::string_view name;  ///< "SPEC_SLICED"
    std::uint32_t off = 0;
};

/// An additional field of every splat's record.
struct RecordField {
    std::string_view name;
    std::uint32_t bytes;
};

/// One effect. The lists name everything that exists for it; several effects may list the same name.
struct Effect {
    std::string_view name;
    std::string_view help;  ///< what it shows, in one line
    std::string_view call;  ///< how a scene or the command line enables it
    /// The values of the request that enable it, as a sentence; empty if it is off.
    std::string (*reason)(const FrameRequest&);
    /// Enables it in a request, with values of typical cost.
    void (*turn_on)(FrameRequest&);
    /// Prepares a plain request (plain_request()) such that turn_on() then adds this effect only.
    void (*base)(FrameRequest&) = nullptr;
    std::vector<std::string_view> passes{};         ///< passes that run for it
    std::vector<std::string_view> resources{};      ///< names of images and buffers that exist for it
    std::vector<std::string_view> resized{};        ///< names of every frame's resources whose size it changes
    std::vector<RecordField> record{};              ///< fields of the splat record
    std::vector<EffectConstant> constants{};        ///< specialization constants that it changes
    std::vector<std::string_view> frame_fields{};   ///< members of FrameParams that only frames with it read
    std::vector<std::string_view> volume_fields{};  ///< likewise of VolumeParams
    std::vector<std::string_view> scene_fields{};   ///< members of SceneParams that only frames with it read
};

/// All effects, in the order of the table.
std::span<const Effect> effect_table();

/// The effect of that name; throws Error listing the names.
const Effect& effect_named(std::string_view name);

/// The same picture with every effect off: unlit materials, plain kernels, whole sheets, every pixel drawn.
FrameRequest plain_request(FrameRequest request);

}  // namespace edgesplat
