// --renderer and --tolerance of `edgesplat render`: which way to the picture.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string_view>

enum class RendererKind { Splat, Reference, Truth };

struct RendererOptions {
    RendererKind kind = RendererKind::Splat;
    double tolerance = 1e-4;  ///< reference and truth: largest error of a pixel and channel, (0, 0.1]
};

/// Whether it computes on the processor alone and needs no Vulkan device.
bool on_processor(RendererKind kind);

/// The name as the command line spells it.
std::string_view name_of(RendererKind kind);

/// Adds --renderer and --tolerance.
void add_renderer_options(CLI::App& command, RendererOptions& options);
