#include "footprints/cache_folder.h"

#include <cstdlib>

namespace edgesplat {

std::filesystem::path cache_folder() {
    const auto variable = [](const char* name) -> std::filesystem::path {
        const char* value = std::getenv(name);
        return value ? value : "";
    };
    if (std::filesystem::path own = variable("EDGESPLAT_CACHE"); !own.empty()) return own;
    if (std::filesystem::path xdg = variable("XDG_CACHE_HOME"); xdg.is_absolute()) return xdg / "edgesplat";
    if (std::filesystem::path home = variable("HOME"); !home.empty()) return home / ".cache" / "edgesplat";
    return {};
}

}  // namespace edgesplat
