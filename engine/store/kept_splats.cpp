#include "engine/store/kept_splats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "engine/checked_file.h"
#include "engine/fnv1a.h"
#include "engine/gpu/shader.h"
#include "engine/plan/resource_table.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kKind = "ESPLSPLT";
// What a list contains beyond what the shaders say. A change of it makes older files useless.
constexpr std::uint32_t kVersion = 1;

template <typename T>
std::string_view bytes_of(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// Appends values to bytes.
class Writer {
  public:
    explicit Writer(std::vector<std::uint8_t>& bytes) : bytes_(&bytes) {}
    template <typename T>
    Writer& list(std::span<const T> values) {
        one(std::uint64_t{values.size()});
        return raw(bytes_of(values));
    }
    template <typename T>
    Writer& one(const T& value) {
        return raw(bytes_of(std::span(&value, 1)));
    }

  private:
    Writer& raw(std::string_view text) {
        bytes_->insert(bytes_->end(), text.begin(), text.end());
        return *this;
    }
    std::vector<std::uint8_t>* bytes_;
};

/// Takes values from bytes in the same order. Once too few are left, all that follows is empty and good() is false.
class Reader {
  public:
    explicit Reader(std::span<const std::uint8_t> bytes) : left_(bytes) {}
    template <typename T>
    std::vector<T> list() {
        const auto count = one<std::uint64_t>();
        good_ = good_ && count <= left_.size() / sizeof(T);
        std::vector<T> values(good_ ? count : 0);
        take(values.data(), values.size() * sizeof(T));
        return values;
    }
    template <typename T>
    T one() {
        T value{};
        good_ = good_ && sizeof(T) <= left_.size();
        if (good_) take(&value, sizeof(T));
        return value;
    }
    bool good() const { return good_; }
    bool at_end() const { return left_.empty(); }

  private:
    void take(void* to, std::size_t bytes) {
        if (bytes == 0) return;
        std::memcpy(to, left_.data(), bytes);
        left_ = left_.subspan(bytes);
    }
    std::span<const std::uint8_t> left_;
    bool good_ = true;
};

/// Of every shader of the program.
std::uint64_t shaders_checksum() {
    std::uint64_t sum = 0;
    for (const gpu::EmbeddedShader& shader : gpu::embedded_shaders())
        sum = sum * 31 + fnv1a(bytes_of(shader.words));
    return sum;
}

/// Whether bricks cover a list from its beginning to its end, in order, in a volume.
bool cover(const std::vector<SplatBrick>& bricks, std::uint64_t splats, const glm::ivec3& dims) {
    std::uint64_t next = 0;
    for (const SplatBrick& brick : bricks) {
        const VoxelBox& box = brick.box;
        const bool in_volume = glm::all(glm::greaterThanEqual(box.low, glm::ivec3(0))) &&
                               glm::all(glm::lessThanEqual(box.low, box.high)) &&
                               glm::all(glm::lessThan(box.high, dims));
        if (brick.first != next || brick.count == 0 || !in_volume) return false;
        next += brick.count;
    }
    return next == splats;
}

fs::path file_of(const fs::path& folder, const std::string& key) {
    return folder / fmt::format("splats-{:016x}.bin", fnv1a(key));
}

/// Removes the files read longest ago until `more` bytes fit.
void make_room(const fs::path& folder, std::uint64_t more, std::uint64_t most_bytes) {
    struct Kept {
        fs::file_time_type read;
        std::uint64_t bytes;
        fs::path path;
    };
    std::vector<Kept> files;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        const std::string name = at->path().filename().string();
        std::error_code none;
        if (!name.starts_with("splats-") || !name.ends_with(".bin") || !at->is_regular_file(none)) continue;
        files.push_back({at->last_write_time(none), at->file_size(none), at->path()});
    }
    std::ranges::sort(files, {}, &Kept::read);
    std::uint64_t all = more;
    for (const Kept& file : files)
        all += file.bytes;
    for (const Kept& file : files) {
        if (all <= most_bytes) break;
        fs::remove(file.path, error);
        all -= file.bytes;
    }
}

}  // namespace

std::string splats_key(const gpu::Device& device, const Volume& volume, const CollectionPlan& plan) {
    std::vector<std::uint8_t> bytes;
    Writer key(bytes);
    const auto properties = device.physical().getProperties();
    key.one(kVersion).one(shaders_checksum());
    key.one(properties.vendorID).one(properties.deviceID).one(properties.driverVersion);
    for (const std::uint8_t byte : properties.pipelineCacheUUID)
        key.one(byte);
    key.one(fnv1a(bytes_of(std::span<const float>(volume.values)))).one(volume.min_value).one(volume.max_value);
    const bool labels = plan.labels != 0 && volume.shown_labels;
    key.one(labels ? fnv1a(bytes_of(std::span<const std::uint32_t>(volume.shown_labels->at))) : 0U);
    // The plan, field by field: there is padding between fields.
    key.one(plan.dims).one(plan.estimator).one(plan.labels).one(plan.clip.keep).one(plan.clip.remove);
    for (const bool flag : {plan.edge_field, plan.buried, plan.skip_buried, plan.faces, plan.two_values, plan.surfaces})
        key.one(flag);
    for (const shader::TransferRow& row : plan.transfer)
        key.one(row);
    key.one(plan.params);
    return {bytes.begin(), bytes.end()};
}

std::vector<std::uint8_t> pack(const KeptSplats& kept, const std::string& key) {
    std::vector<std::uint8_t> bytes;
    Writer out(bytes);
    out.list(std::span(key.data(), key.size()));
    out.one(kept.splats).one(kept.with_edge).one(kept.with_crease).one(kept.traced);
    out.one(kept.low).one(kept.high).one(kept.border);
    out.list(std::span<const SplatBrick>(kept.bricks));
    for (const std::vector<std::uint8_t>& list : kept.lists)
        out.list(std::span<const std::uint8_t>(list));
    return bytes;
}

std::optional<KeptSplats> unpack_splats(const std::vector<std::uint8_t>& bytes, const std::string& key,
                                        const CollectionPlan& plan) {
    Reader in(bytes);
    const std::vector<char> its_key = in.list<char>();
    if (!std::ranges::equal(its_key, key)) return std::nullopt;
    KeptSplats kept;
    kept.splats = in.one<std::uint64_t>();
    kept.with_edge = in.one<std::uint64_t>();
    kept.with_crease = in.one<std::uint64_t>();
    kept.traced = in.one<std::uint64_t>();
    kept.low = in.one<glm::ivec3>();
    kept.high = in.one<glm::ivec3>();
    kept.border = in.one<std::uint32_t>();
    kept.bricks = in.list<SplatBrick>();
    bool fits = cover(kept.bricks, kept.splats, plan.dims);
    for (const SplatListRow& row : splat_list_rows()) {
        kept.lists.push_back(in.list<std::uint8_t>());
        fits = fits && kept.lists.back().size() == kept.splats * row.bytes(plan);
    }
    const bool in_volume =
        glm::all(glm::greaterThanEqual(kept.low, glm::ivec3(0))) && glm::all(glm::lessThan(kept.high, plan.dims));
    return in.good() && in.at_end() && fits && in_volume ? std::optional(std::move(kept)) : std::nullopt;
}

std::optional<KeptSplats> read_splats(const fs::path& folder, const std::string& key, const CollectionPlan& plan) {
    const fs::path file = file_of(folder, key);
    auto kept = unpack_splats(read_checked_file(file, kKind), key, plan);
    std::error_code ignored;
    if (kept) fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
    return kept;
}

bool keep_splats(const fs::path& folder, const std::string& key, const KeptSplats& kept, std::uint64_t most_bytes) {
    const std::vector<std::uint8_t> bytes = pack(kept, key);
    if (bytes.size() > most_bytes) return false;
    make_room(folder, bytes.size(), most_bytes);
    return write_checked_file(file_of(folder, key), kKind, bytes);
}

}  // namespace edgesplat
