// The suites in the program: benchmarks/*.toml (cmake/EmbedToml.cmake).
#pragma once

#include <span>
#include <string_view>

namespace edgesplat::bench {

struct EmbeddedSuite {
    std::string_view name, text;  ///< file name without its ending; the file's TOML
};

std::span<const EmbeddedSuite> embedded_suites();

}  // namespace edgesplat::bench
