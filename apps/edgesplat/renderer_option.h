// --renderer, --raycast-step and --tolerance of `edgesplat render`: which way to the picture.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string_view>

#include "engine/renderer.h"

enum class RendererKind { Splat, Raycast, RaycastWarped, Reference, Truth };

struct RendererOptions {
    RendererKind kind = RendererKind::Splat;
    double raycast_step = 0.5;  ///< raycast, raycast-warped: voxels, (0.01, 4]
    double tolerance = 1e-4;    ///< reference and truth: largest error of a pixel and channel, (0, 0.1]
};

/// Whether it computes on the processor alone and needs no Vulkan device.
bool on_processor(RendererKind kind);

/// Whether it is the ray caster, in either way.
bool casts_rays(RendererKind kind);

/// How the ray caster is to sample.
edgesplat::RaycastSettings raycast_settings(const RendererOptions& options);

/// The name as the command line spells it.
std::string_view name_of(RendererKind kind);

/// Adds --renderer, --raycast-step and --tolerance.
void add_renderer_options(CLI::App& command, RendererOptions& options);
