#include "engine/gpu/kept_commands.h"

#include <algorithm>

namespace edgesplat::gpu {
namespace {

/// Commands, and words that some of them bring along.
std::size_t weight_of(const CommandList& list) {
    std::size_t weight = list.size();
    for (const Command& one : list)
        if (const auto* update = std::get_if<command::Update>(&one)) weight += update->values.size();
    return weight;
}

}  // namespace

KeptCommands::KeptCommands(const Device& device)
    : device_(&device),
      pool_(device.handle(), {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, device.queue_family()}) {}

vk::CommandBuffer KeptCommands::of(const CommandList& list) {
    const auto same = std::ranges::find_if(kept_, [&](const Kept& kept) { return kept.list == list; });
    if (same != kept_.end()) {
        std::rotate(same, same + 1, kept_.end());
        ++replayed_;
        return *kept_.back().buffer;
    }
    const std::size_t weight = weight_of(list);
    std::size_t all = weight;
    for (const Kept& kept : kept_)
        all += kept.weight;
    vk::raii::CommandBuffer buffer = nullptr;
    while (!kept_.empty() && (kept_.size() >= kMostLists || all > kMostCommands)) {
        all -= kept_.front().weight;
        buffer = std::move(kept_.front().buffer);
        kept_.erase(kept_.begin());
    }
    if (!*buffer) {
        const vk::CommandBufferAllocateInfo one(*pool_, vk::CommandBufferLevel::ePrimary, 1);
        buffer = std::move(vk::raii::CommandBuffers(device_->handle(), one).front());
    }
    record(buffer, list);
    ++recorded_;
    kept_.push_back({list, weight, std::move(buffer)});
    return *kept_.back().buffer;
}

void KeptCommands::clear() {
    kept_.clear();
}

}  // namespace edgesplat::gpu
