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

glm::uvec3 local_size(std::string_view name) {
    constexpr std::size_t kHeader = 5;
    constexpr std::uint32_t kConstant = 43, kFunction = 54, kExecutionModeId = 331, kLocalSizeId = 38;
    const auto words = find_shader(name);
    glm::uvec3 ids(0), size(0);  // of the constants, which follow the execution mode
    for (std::size_t at = kHeader; at < words.size(); at += words[at] >> 16U) {
        const std::uint32_t instruction = words[at] & 0xffffU;
        if (instruction == kFunction) break;
        if (instruction == kExecutionModeId && words[at + 2] == kLocalSizeId)
            ids = {words[at + 3], words[at + 4], words[at + 5]};
        for (int axis = 0; axis < 3; ++axis)
            if (instruction == kConstant && words[at + 2] == ids[axis]) size[axis] = words[at + 3];
    }
    if (glm::any(glm::equal(size, glm::uvec3(0))))
        throw std::logic_error("no fixed local size in " + std::string(name));
    return size;
}

}  // namespace edgesplat::gpu
