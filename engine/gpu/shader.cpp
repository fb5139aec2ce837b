#include "engine/gpu/shader.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

namespace edgesplat::gpu {

std::span<const std::uint32_t> find_shader(std::string_view name) {
    const auto shaders = embedded_shaders();
    const auto found = std::find_if(shaders.begin(), shaders.end(), [&](const auto& s) { return s.name == name; });
    if (found == shaders.end()) throw std::logic_error("no shader named " + std::string(name));
    return found->words;
}

namespace {

/// 0 where a specialization constant sets the size.
glm::uvec3 fixed_size(std::span<const std::uint32_t> words) {
    constexpr std::size_t kHeader = 5;
    constexpr std::uint32_t kConstant = 43, kFunction = 54, kExecutionModeId = 331, kLocalSizeId = 38;
    glm::uvec3 ids(0), size(0);  // of the constants, which follow the execution mode
    for (std::size_t at = kHeader; at < words.size(); at += words[at] >> 16U) {
        const std::uint32_t instruction = words[at] & 0xffffU;
        if (instruction == kFunction) break;
        if (instruction == kExecutionModeId && words[at + 2] == kLocalSizeId)
            ids = {words[at + 3], words[at + 4], words[at + 5]};
        for (int axis = 0; axis < 3; ++axis)
            if (instruction == kConstant && words[at + 2] == ids[axis]) size[axis] = words[at + 3];
    }
    return size;
}

}  // namespace

glm::uvec3 local_size(std::string_view name) {
    static const auto sizes = [] {
        std::map<std::string_view, glm::uvec3> all;
        for (const EmbeddedShader& shader : embedded_shaders())
            all.emplace(shader.name, fixed_size(shader.words));
        return all;
    }();
    const auto found = sizes.find(name);
    if (found == sizes.end() || glm::any(glm::equal(found->second, glm::uvec3(0))))
        throw std::logic_error("no fixed local size in " + std::string(name));
    return found->second;
}

}  // namespace edgesplat::gpu
