#include "engine/gpu/pipeline_cache.h"

#include <fmt/format.h>

#include "engine/checked_file.h"

namespace edgesplat::gpu {

namespace fs = std::filesystem;

namespace {

// Drivers check that cache data is their own, but not all check that it is undamaged: hence the checksum.
constexpr std::string_view kKind = "ESPLATPC";

}  // namespace

PipelineCache::PipelineCache(const Device& device, const fs::path& folder) {
    std::vector<std::uint8_t> data;
    if (!folder.empty()) {
        const auto properties = device.physical().getProperties();
        std::string uuid;
        for (const std::uint8_t byte : properties.pipelineCacheUUID)
            uuid += fmt::format("{:02x}", byte);
        file_ = folder / fmt::format("pipelines-{:08x}-{:08x}-{:08x}-{}.bin", properties.vendorID, properties.deviceID,
                                     properties.driverVersion, uuid);
        data = read_checked_file(file_, kKind);
    }
    loaded_ = data.size();
    cache_ = vk::raii::PipelineCache(device.handle(), vk::PipelineCacheCreateInfo({}, data.size(), data.data()));
}

PipelineCache::~PipelineCache() {
    try {
        save();
    } catch (...) {  // NOLINT(bugprone-empty-catch): the next start compiles again
    }
}

bool PipelineCache::save() {
    if (!changed_ || file_.empty() || !*cache_) return true;
    changed_ = false;
    return write_checked_file(file_, kKind, cache_.getData());
}

}  // namespace edgesplat::gpu
