// Command buffers that were recorded, to be replayed when the same commands are asked for again.
#pragma once

#include "engine/gpu/command_list.h"
#include "engine/gpu/device.h"

namespace edgesplat::gpu {

/// Keeps the lists that were last asked for, at most kMostLists of them and kMostCommands in all, each word that a
/// command brings along counting as one. None may be asked for
/// while the device still runs the one before.
class KeptCommands {
  public:
    static constexpr std::size_t kMostLists = 256;       ///< a frame in rounds has twenty to forty
    static constexpr std::size_t kMostCommands = 65536;  ///< a frame of 10^4 sheets has 25000

    explicit KeptCommands(const Device& device);

    /// A buffer that runs `list`: an earlier recording of an equal one, or a new one.
    vk::CommandBuffer of(const CommandList& list);
    /// Nothing is kept any longer.
    void clear();

    std::uint64_t recorded() const { return recorded_; }
    std::uint64_t replayed() const { return replayed_; }

  private:
    struct Kept {
        CommandList list;
        std::size_t weight = 0;  ///< counts towards kMostCommands
        vk::raii::CommandBuffer buffer = nullptr;
    };
    const Device* device_;
    vk::raii::CommandPool pool_;
    std::vector<Kept> kept_;  ///< last used last
    std::uint64_t recorded_ = 0, replayed_ = 0;
};

}  // namespace edgesplat::gpu
