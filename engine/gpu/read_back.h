// Copies the contents of a device buffer to the host and waits.
#pragma once

#include <vector>

#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"

namespace edgesplat::gpu {

/// Elements [first, first + count) of the buffer.
template <typename T>
std::vector<T> read_back(const Device& device, Commands& commands, const Buffer& buffer, std::size_t first,
                         std::size_t count) {
    const Buffer host(device, count * sizeof(T), Buffer::Place::Host, "read back");
    commands.run([&] {
        const vk::BufferCopy copy(first * sizeof(T), 0, count * sizeof(T));
        commands.copy(buffer, host, {copy});
    });
    const auto mapped = host.mapped<T>(count);
    return {mapped.begin(), mapped.end()};
}

}  // namespace edgesplat::gpu
