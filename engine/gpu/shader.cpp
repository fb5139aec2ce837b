#include "engine/gpu/shader.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace edgesplat::gpu {

std::span<const std::uint32_t> find_shader(std::string_view name) {
    const auto shaders = embedded_shaders();
    const auto found = std::find_if(shaders.begin(), shaders.end(), [&](const auto& s) { return s.name == name; });
    if (found == shaders.end()) throw std::logic_error("no shader named " + std::string(name));
    return found->words;
}

}  // namespace edgesplat::gpu
