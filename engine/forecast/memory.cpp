#include "engine/forecast/memory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "engine/error.h"
#include "engine/gpu/buffer.h"
#include "engine/store/light.h"

namespace edgesplat {
namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;

double mebibytes(std::uint64_t bytes) {
    return static_cast<double>(bytes) / kMebibyte;
}

/// Bytes of one resource on the device; adds a sentence to need.too_large if it exceeds a limit.
std::uint64_t bytes_on(const gpu::Device& device, const PlannedResource& resource, MemoryNeed& need) {
    const std::string beyond = resource.image ? gpu::exceeds_limits(device, *resource.image)
                               : resource.texels != vk::Format{}
                                   ? gpu::Buffer::texel_limit_error(device, resource.bytes, resource.texels)
                                   : "";
    if (!beyond.empty()) {
        need.too_large.push_back(fmt::format("{}: {}", resource.text.name, beyond));
        return resource.bytes;
    }
    const std::uint64_t bytes = resource.image ? gpu::required_bytes(device, *resource.image)
                                               : gpu::Buffer::required_bytes(device, resource.bytes);
    if (bytes > device.largest_allocation()) {
        need.too_large.push_back(fmt::format("{}: {:.1f} MiB in one piece; {} allows {:.1f} MiB", resource.text.name,
                                             mebibytes(bytes), device.info().name,
                                             mebibytes(device.largest_allocation())));
    }
    return bytes;
}

/// The central part of a volume, `eighths` / 8 of its voxels along each axis.
std::shared_ptr<const Volume> middle_of(const Volume& volume, int eighths) {
    const auto part = std::make_shared<Volume>();
    const glm::ivec3 dims = volume.geometry.dims;
    part->geometry = volume.geometry;
    part->geometry.dims = glm::max(dims * eighths / 8, glm::ivec3(1));
    const glm::ivec3 low = (dims - part->geometry.dims) / 2, size = part->geometry.dims;
    part->geometry.origin = volume.geometry.to_world(low);
    part->values.reserve(part->geometry.voxel_count());
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                part->values.push_back(volume.at(low.x + x, low.y + y, low.z + z));
    // The whole volume's range: the scene's iso-values keep their meaning.
    part->min_value = volume.min_value;
    part->max_value = volume.max_value;
    part->name = volume.name;
    return part;
}

/// Whether a request fits. Splats are counted on the host if the upper bound by voxels does not fit.
class Fit {
  public:
    Fit(const gpu::Device& device, std::uint64_t budget) : device_(&device), budget_(budget) {}

    bool operator()(const FrameRequest& request) const {
        try {
            const auto fits = [&](const SplatCounter& count) {
                return memory_need(*device_, forecast_frame(request, count, device_->profile()), budget_).fits();
            };
            return fits(most_splats_of) || fits(count_splats_of);
        } catch (const Error&) {
            return false;  // too many sheets
        }
    }

  private:
    const gpu::Device* device_;
    std::uint64_t budget_;
};

/// The largest picture of the same aspect that fits; nullopt if 1/1000 of the size does not.
std::optional<glm::ivec2> largest_size(const Fit& fits, FrameRequest request) {
    const glm::dvec2 whole(request.size);
    const auto scaled = [&](int thousandths) {
        return glm::max(glm::ivec2(glm::floor(whole * (thousandths / 1000.0))), glm::ivec2(1));
    };
    const auto fits_at = [&](int thousandths) {
        request.size = scaled(thousandths);
        return fits(request);
    };
    if (!fits_at(1)) return std::nullopt;
    int fitting = 1, beyond = 1000;
    while (beyond - fitting > 1) {
        const int middle = (fitting + beyond) / 2;
        (fits_at(middle) ? fitting : beyond) = middle;
    }
    return scaled(fitting);
}

}  // namespace

MemoryNeed memory_need(const gpu::Device& device, const FrameForecast& forecast, std::uint64_t budget) {
    MemoryNeed need;
    const auto& held = device.allocations();
    const auto held_as = [&](const std::string& name) {
        const auto found = held.find(name);
        return found == held.end() ? std::uint64_t{0} : found->second.bytes;
    };
    // Two places: [0] device, [1] host.
    struct Sums {
        std::array<std::uint64_t, 5> by_time{};  ///< Held
        std::uint64_t before = 0;                ///< allocated now under the names of this frame
        std::uint64_t picture_before = 0;        ///< the part of `before` with lifetime Drawing
    };
    std::array<Sums, 2> sums;
    std::map<std::string, MemoryNeed::Row> rows;
    std::map<std::pair<std::string, Held>, std::pair<std::uint64_t, const PlannedResource*>> merged;
    for (const PlannedResource& resource : forecast.resources) {
        auto& [bytes, one] = merged[{resource.text.name, resource.held}];
        const std::uint64_t own = bytes_on(device, resource, need);
        bytes += own;
        one = &resource;
        if (resource.volume) need.of_volumes[*resource.volume] += own;
    }
    std::uint64_t kept = device.allocated_bytes();
    bool uploads = false;  // data already on the device needs no staging buffer
    for (const auto& [key, entry] : merged) {
        const auto& [name, when] = key;
        const auto& [bytes, resource] = entry;
        const std::uint64_t before = held_as(name);
        uploads = uploads || (resource->image && resource->text.written == "host" && before < bytes);
        using Place = gpu::Buffer::Place;
        const bool on_host =
            resource->place == Place::Host || (resource->place == Place::Shared && !device.profile().own_memory);
        Sums& place = sums.at(on_host ? 1 : 0);
        const bool first = rows.try_emplace(name, MemoryNeed::Row{name, 0, before}).second;
        rows[name].needed = std::max(rows[name].needed, bytes);
        place.by_time.at(static_cast<std::size_t>(when)) += resource->grows ? std::max(bytes, before) : bytes;
        if (first) {
            place.before += before;
            kept -= before;
        }
        if (when == Held::Drawing) place.picture_before += before;
    }
    for (auto& [name, row] : rows)
        need.rows.push_back(std::move(row));
    std::ranges::sort(need.rows, std::ranges::greater(), &MemoryNeed::Row::needed);

    const auto most = [uploads](const Sums& s) {
        const auto& t = s.by_time;
        const auto at = [&](Held when) { return t.at(static_cast<std::size_t>(when)); };
        return at(Held::Always) + std::max({uploads ? at(Held::Uploading) + s.picture_before : 0,
                                            at(Held::Lighting) + s.picture_before, at(Held::Drawing)});
    };
    Sums both;
    for (const Sums& place : sums) {
        for (std::size_t i = 0; i < both.by_time.size(); ++i)
            both.by_time.at(i) += place.by_time.at(i);
        both.before += place.before;
        both.picture_before += place.picture_before;
    }
    // The limit with the least spare memory decides.
    std::optional<double> least;
    const auto limit = [&](std::uint64_t total, std::uint64_t available, const std::string& by) {
        const double spare = static_cast<double>(available) - static_cast<double>(total);
        if (least && spare >= *least) return;
        least = spare;
        need.total = total;
        need.available = available;
        need.limited_by = by;
    };
    const auto heap_limit = [&](std::uint32_t heap, const Sums& place) {
        limit(most(place) + kept, device.free_bytes(heap) + place.before + kept,
              fmt::format("the free memory of heap {} of {}", heap, device.info().name));
    };
    const std::uint32_t device_heap = device.heap_of(false), host_heap = device.heap_of(true);
    if (device_heap == host_heap) {
        heap_limit(device_heap, both);
    } else {
        heap_limit(device_heap, sums[0]);
        heap_limit(host_heap, sums[1]);
    }
    if (budget > 0) limit(most(both) + kept, budget, "the memory budget");
    return need;
}

std::vector<FittingChange> fitting_changes(const gpu::Device& device, const FrameRequest& request,
                                           std::uint64_t budget) {
    const Fit fits(device, budget);
    std::vector<FittingChange> changes;
    const auto offer = [&](std::string text, const FrameRequest& changed) {
        if (fits(changed)) changes.push_back({std::move(text), changed});
    };
    const auto offer_size = [&](const std::string& before, FrameRequest changed) {
        const auto size = largest_size(fits, changed);
        if (!size) return;
        changed.size = *size;
        changes.push_back({fmt::format("{}--size {}x{}", before, size->x, size->y), changed});
    };
    FrameRequest changed = request;
    offer_size("", request);
    if (request.settings.sheet_format != SheetFormat::Tiles) {
        changed.settings.sheet_format = SheetFormat::Tiles;
        offer("--sheet-format tiles", changed);
    }
    changed = request;
    if (request.settings.sheets == SheetCut::Sliced) {
        changed.settings.sheets = SheetCut::Whole;
        offer("--sheets whole", changed);
    }
    changed = request;
    if (request.settings.edges == EdgeEstimator::Cubic) {
        changed.settings.edges = EdgeEstimator::March;
        offer("--edges march", changed);
    }
    changed = request;
    if (request.outputs.tau) {
        changed.outputs.tau = false;
        offer("without output tau, which needs every voxel", changed);
    }
    const auto offer_crop = [&](const std::string& before, FrameRequest cropped) {
        for (int eighths = 7; eighths > 0; --eighths) {
            cropped.volume = middle_of(*request.volume, eighths);
            const glm::ivec3 dims = cropped.volume->geometry.dims;
            const auto known = changes.size();
            offer(fmt::format("{}a crop of the volume to {} x {} x {} voxels", before, dims.x, dims.y, dims.z),
                  cropped);
            if (changes.size() > known) return;
        }
    };
    offer_crop("", request);
    if (changes.empty()) {
        changed = request;
        changed.size = glm::max(request.size / 4, glm::ivec2(1));
        offer_crop(fmt::format("--size {}x{} and ", changed.size.x, changed.size.y), changed);
    }
    return changes;
}

void refuse_memory(const gpu::Device& device, const FrameRequest& request, const MemoryNeed& need,
                   std::uint64_t budget) {
    std::string text =
        fmt::format("the frame needs {:.2f} MiB of memory on {}, but {:.2f} MiB are available ({})",
                    mebibytes(need.total), device.info().name, mebibytes(need.available), need.limited_by);
    for (const std::string& sentence : need.too_large)
        text += "\n  " + sentence;
    std::uint64_t rest = need.total;
    constexpr std::size_t kRows = 8;
    for (std::size_t i = 0; i < std::min(need.rows.size(), kRows); ++i) {
        text += fmt::format("\n  {:<22} {:>10.2f} MiB", need.rows[i].name, mebibytes(need.rows[i].needed));
        rest -= std::min(rest, need.rows[i].needed);
    }
    text += fmt::format("\n  {:<22} {:>10.2f} MiB", "everything else", mebibytes(rest));
    if (need.of_volumes.size() > 1)
        for (const auto& [number, bytes] : need.of_volumes)
            text += fmt::format("\n  {:>10.2f} MiB of it for {}", mebibytes(bytes),
                                request_of_volume(request, number).volume->name);
    const auto changes = fitting_changes(device, request, budget);
    text += changes.empty() ? "\nno smaller picture or part of this volume fits" : "\neach of these changes fits:";
    for (const FittingChange& change : changes)
        text += "\n  " + change.text;
    fail("{}", text);
}

}  // namespace edgesplat
