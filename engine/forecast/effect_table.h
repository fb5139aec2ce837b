// The table of effects: for each, what calls for it and what it adds to a frame. The frame's description, the command
// that measures what effects cost, and the tests that an effect which is off costs nothing are made from it.
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

/// What every splat carries more.
struct RecordField {
    std::string_view name;
    std::uint32_t bytes;
};

/// One effect. Lists name what is there because of it: another effect may call for the same.
struct Effect {
    std::string_view name;
    std::string_view help;  ///< what it shows, in one line
    std::string_view call;  ///< how a scene or the command line calls for it
    /// The values of the request that call for it, as a sentence; empty: nothing does.
    std::string (*reason)(const FrameRequest&);
    /// Makes a request call for it, with values that cost what is usual.
    void (*turn_on)(FrameRequest&);
    /// Makes of a plain request (plain_request()) one that differs from the effect's by the effect alone.
    void (*base)(FrameRequest&) = nullptr;
    std::vector<std::string_view> passes{};        ///< that run for it
    std::vector<std::string_view> resources{};     ///< images and buffers that are there for it, by their names
    std::vector<std::string_view> resized{};       ///< those of every frame that are of another size with it
    std::vector<RecordField> record{};             ///< fields of the splat record
    std::vector<EffectConstant> constants{};       ///< pipeline variants
    std::vector<std::string_view> frame_fields{};  ///< members of FrameParams that no frame without it reads
    std::vector<std::string_view> scene_fields{};  ///< likewise of SceneParams
};

/// All effects, in the order of the pipeline.
std::span<const Effect> effect_table();

/// The effect of that name; throws Error listing the names.
const Effect& effect_named(std::string_view name);

/// The same picture with every effect off: one unlit material over nothing, plain kernels, whole, in float sheets.
FrameRequest plain_request(FrameRequest request);

}  // namespace edgesplat
