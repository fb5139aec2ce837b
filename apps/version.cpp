#include "apps/version.h"

#include <fmt/format.h>

std::string version_text(std::string_view program) {
    const std::string_view commit = built_commit();
    return fmt::format("{} {}{}\nbuilt with {}", program, EDGESPLAT_VERSION,
                       commit.empty() ? "" : fmt::format(" (commit {})", commit), EDGESPLAT_LIBRARIES);
}
