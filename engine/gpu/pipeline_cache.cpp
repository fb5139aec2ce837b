#include "engine/gpu/pipeline_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <fstream>
#include <iterator>
#include <system_error>

namespace edgesplat::gpu {
namespace {

namespace fs = std::filesystem;

// Drivers check whose data they are given, not all of them whether it is whole.
struct Header {
    std::array<char, 8> magic = {'E', 'S', 'P', 'L', 'A', 'T', 'P', 'C'};
    std::uint64_t bytes = 0, checksum = 0;
    bool operator==(const Header&) const = default;
};

std::uint64_t checksum_of(const std::vector<std::uint8_t>& data) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const std::uint8_t byte : data)
        hash = (hash ^ byte) * 0x100000001b3U;
    return hash;
}

Header header_of(const std::vector<std::uint8_t>& data) {
    Header header;
    header.bytes = data.size();
    header.checksum = checksum_of(data);
    return header;
}

std::vector<std::uint8_t> read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    Header header;
    if (!in.read(reinterpret_cast<char*>(&header), sizeof header)) return {};
    std::vector<std::uint8_t> data{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    return header == header_of(data) ? data : std::vector<std::uint8_t>{};
}

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
        data = read(file_);
    }
    loaded_ = data.size();
    cache_ = vk::raii::PipelineCache(device.handle(), vk::PipelineCacheCreateInfo({}, data.size(), data.data()));
}

PipelineCache::~PipelineCache() {
    try {
        save();
    } catch (...) {  // NOLINT(bugprone-empty-catch): what cannot be kept is compiled again
    }
}

bool PipelineCache::save() {
    if (!changed_ || file_.empty() || !*cache_) return true;
    changed_ = false;
    const std::vector<std::uint8_t> data = cache_.getData();
    const Header header = header_of(data);
    std::error_code error;
    fs::create_directories(file_.parent_path(), error);
    static std::atomic<unsigned> counter{0};  // several threads of one process
    const fs::path temporary = fmt::format("{}.{}.{}.tmp", file_.string(), ::getpid(), counter++);
    std::ofstream out(temporary, std::ios::binary);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
    out.close();
    if (out) fs::rename(temporary, file_, error);
    if (out && !error) return true;
    fs::remove(temporary, error);
    return false;
}

}  // namespace edgesplat::gpu
