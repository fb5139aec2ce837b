#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

#include "engine/files/memory_file.h"
#include "engine/volume/io/hdf5.h"

namespace edgesplat::detail {
namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t) && sizeof(hsize_t) == sizeof(std::uint64_t));

/// Holds the HDF5 lock and disables HDF5's error printing, because the messages here replace it. Restores the printing
/// afterwards: other users of the library detect failures by it.
class Quiet {
  public:
    Quiet() : lock_(hdf5_mutex()) {
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~Quiet() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;

  private:
    std::lock_guard<std::recursive_mutex> lock_;
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

/// HDF5's description of the innermost error.
std::string reason() {
    std::string text;
    const auto keep_first = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
        auto& kept = *static_cast<std::string*>(data);
        if (kept.empty() && error->desc != nullptr) kept = error->desc;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &text);
    // For system errors, only the system's message; the rest is times, offsets and addresses.
    constexpr std::string_view kNumber = "errno = ";
    if (const std::size_t at = text.find(kNumber); at != std::string::npos) {
        int number = 0;
        std::from_chars(text.data() + at + kNumber.size(), text.data() + text.size(), number);
        if (number != 0) return std::generic_category().message(number);
    }
    return text.empty() ? "no reason given" : text;
}

hid_t memory_type(SampleType type) {
    switch (type) {
        case SampleType::Int8:
            return H5T_NATIVE_INT8;
        case SampleType::UInt8:
            return H5T_NATIVE_UINT8;
        case SampleType::Int16:
            return H5T_NATIVE_INT16;
        case SampleType::UInt16:
            return H5T_NATIVE_UINT16;
        case SampleType::Int32:
            return H5T_NATIVE_INT32;
        case SampleType::UInt32:
            return H5T_NATIVE_UINT32;
        case SampleType::Int64:
            return H5T_NATIVE_INT64;
        case SampleType::UInt64:
            return H5T_NATIVE_UINT64;
        case SampleType::Float32:
            return H5T_NATIVE_FLOAT;
        case SampleType::Float64:
            return H5T_NATIVE_DOUBLE;
    }
    return -1;
}

hid_t file_type(SampleType type) {
    switch (type) {
        case SampleType::Int8:
            return H5T_STD_I8LE;
        case SampleType::UInt8:
            return H5T_STD_U8LE;
        case SampleType::Int16:
            return H5T_STD_I16LE;
        case SampleType::UInt16:
            return H5T_STD_U16LE;
        case SampleType::Int32:
            return H5T_STD_I32LE;
        case SampleType::UInt32:
            return H5T_STD_U32LE;
        case SampleType::Int64:
            return H5T_STD_I64LE;
        case SampleType::UInt64:
            return H5T_STD_U64LE;
        case SampleType::Float32:
            return H5T_IEEE_F32LE;
        case SampleType::Float64:
            return H5T_IEEE_F64LE;
    }
    return -1;
}

/// False for unsupported types.
bool sample_type_of(hid_t type, SampleType& result) {
    const H5T_class_t kind = H5Tget_class(type);
    if (kind == H5T_ENUM) {
        const Hdf5Id base(H5Tget_super(type), H5Tclose);
        return base && sample_type_of(base.get(), result);
    }
    if (kind == H5T_FLOAT && H5Tget_size(type) == 2) {
        result = SampleType::Float32;
        return true;
    }
    const bool is_signed = kind == H5T_INTEGER && H5Tget_sign(type) == H5T_SGN_2;
    const std::size_t bits = 8 * H5Tget_size(type);
    if (kind != H5T_INTEGER && kind != H5T_FLOAT) return false;
    return sample_type_named(fmt::format("{}{}",
                                         kind == H5T_FLOAT ? "float"
                                         : is_signed       ? "int"
                                                           : "uint",
                                         bits),
                             result);
}

Hdf5Id space(const Hdf5Extent& extent) {
    if (extent.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
    const std::vector<hsize_t> sizes(extent.begin(), extent.end());
    return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose};
}

Hdf5Extent extent_of(hid_t space) {
    const int axes = H5Sget_simple_extent_ndims(space);
    std::vector<hsize_t> sizes(static_cast<std::size_t>(std::max(axes, 0)));
    if (axes > 0) H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
    return {sizes.begin(), sizes.end()};
}

/// The dataset's dataspace with a box selected.
Hdf5Id selection(hid_t dataset, const Hdf5Extent& low, const Hdf5Extent& size) {
    Hdf5Id file_space(H5Dget_space(dataset), H5Sclose);
    const std::vector<hsize_t> start(low.begin(), low.end()), count(size.begin(), size.end());
    if (H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0)
        return {};
    return file_space;
}

/// The first filter of a dataset that this library lacks, "lzf (32000)"; empty: none.
std::string missing_filter(hid_t dataset) {
    const Hdf5Id creation(H5Dget_create_plist(dataset), H5Pclose);
    const int count = H5Pget_nfilters(creation.get());
    for (int i = 0; i < count; ++i) {
        unsigned flags = 0;
        std::size_t values = 0;
        std::array<char, 64> name{};
        const auto filter = H5Pget_filter2(creation.get(), static_cast<unsigned>(i), &flags, &values, nullptr,
                                           name.size() - 1, name.data(), nullptr);
        if (filter < 0 || H5Zfilter_avail(filter) > 0) continue;
        return name[0] == '\0' ? fmt::format("number {}", filter) : fmt::format("{} ({})", name.data(), filter);
    }
    return "";
}

/// Disables file locks: they fail on read-only and some network file systems. The creator of the temporary name already
/// locks a written file.
Hdf5Id without_locks() {
    Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
#if H5_VERSION_GE(1, 10, 7)
    H5Pset_file_locking(access.get(), false, true);
#endif
    return access;
}

}  // namespace

std::recursive_mutex& hdf5_mutex() {
    static std::recursive_mutex mutex;
    return mutex;
}

bool Hdf5Id::close() {
    if (id_ < 0) return true;
    const Quiet quiet;
    return close_(std::exchange(id_, -1)) >= 0;
}

void Hdf5Dataset::read(const Hdf5Extent& low, const Hdf5Extent& size, SampleType type, void* out) const {
    const Quiet quiet;
    const Hdf5Id from = selection(id_.get(), low, size), to = space(size);
    if (!from || H5Dread(id_.get(), memory_type(type), to.get(), from.get(), H5P_DEFAULT, out) < 0) {
        const std::string why = reason();
        if (const std::string filter = missing_filter(id_.get()); !filter.empty())
            fail("{}: {}: compressed by the filter {}, which is not available; repack it where it is, e.g. with gzip",
                 file_, name_, filter);
        fail("{}: {}: cannot be read, the file is damaged: {}", file_, name_, why);
    }
}

void Hdf5Dataset::write(const Hdf5Extent& low, const Hdf5Extent& size, SampleType type, const void* data) const {
    const Quiet quiet;
    const Hdf5Id to = selection(id_.get(), low, size), from = space(size);
    if (!to || H5Dwrite(id_.get(), memory_type(type), from.get(), to.get(), H5P_DEFAULT, data) < 0)
        fail("{}: {}: cannot be written: {}", file_, name_, reason());
}

std::uint64_t Hdf5Dataset::stored_bytes() const {
    const Quiet quiet;
    return H5Dget_storage_size(id_.get());
}

std::vector<std::string> Hdf5Dataset::axis_names() const {
    const Quiet quiet;
    std::vector<std::string> names(extent_.size());
    if (H5Aexists(id_.get(), "DIMENSION_LABELS") <= 0) return names;
    const Hdf5Id attribute(H5Aopen(id_.get(), "DIMENSION_LABELS", H5P_DEFAULT), H5Aclose);
    const Hdf5Id type(H5Aget_type(attribute.get()), H5Tclose), extent(H5Aget_space(attribute.get()), H5Sclose);
    if (!type || H5Tis_variable_str(type.get()) <= 0 ||
        H5Sget_simple_extent_npoints(extent.get()) != static_cast<hssize_t>(names.size()))
        return names;
    std::vector<char*> texts(names.size(), nullptr);
    const Hdf5Id memory(H5Tcopy(type.get()), H5Tclose);
    if (H5Aread(attribute.get(), memory.get(), static_cast<void*>(texts.data())) < 0) return names;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (texts[i] != nullptr) names[i] = texts[i];
    H5Dvlen_reclaim(memory.get(), extent.get(), H5P_DEFAULT, static_cast<void*>(texts.data()));
    return names;
}

void Hdf5Dataset::finish() const {
    const Quiet quiet;
    if (H5Dflush(id_.get()) < 0) fail("{}: {}: cannot be written: {}", file_, name_, reason());
}

Hdf5File Hdf5File::open(const std::string& path) {
    const Quiet quiet;
    const Hdf5Id access = without_locks();
    if (H5Fis_hdf5(path.c_str()) <= 0) fail("{}: not an HDF5 file, or truncated in its first bytes", path);
    Hdf5File file;
    file.path_ = path;
    file.id_ = Hdf5Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
    if (!file.id_) fail("{}: cannot be opened, it is truncated or damaged: {}", path, reason());
    return file;
}

Hdf5File Hdf5File::create(const std::string& path, const std::string& shown_path) {
    const Quiet quiet;
    Hdf5File file;
    file.path_ = shown_path;
    const Hdf5Id access = without_locks();
    file.id_ = Hdf5Id(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
    if (!file.id_) fail("{}: cannot be written: {}", shown_path, reason());
    return file;
}

void Hdf5File::abandon() noexcept {
    try {
        const Quiet quiet;
        void* descriptor = nullptr;
        if (H5Fget_vfd_handle(id_.get(), H5P_DEFAULT, &descriptor) < 0) return;
        const MemoryFile nowhere;
        dup3(nowhere.descriptor(), *static_cast<int*>(descriptor), O_CLOEXEC);
    } catch (const std::system_error&) {  // NOLINT(bugprone-empty-catch): the disk may have room by now
    }
}

void Hdf5File::close() {
    const Quiet quiet;
    const bool flushed = H5Fflush(id_.get(), H5F_SCOPE_GLOBAL) >= 0;
    const std::string why = flushed ? "" : reason();
    if (!flushed) abandon();
    if (!id_.close() || !flushed) fail("{}: cannot be written: {}", path_, why);
}

bool Hdf5File::has_attribute(const std::string& name) const {
    const Quiet quiet;
    return H5Aexists(id_.get(), name.c_str()) > 0;
}

Hdf5Id Hdf5File::attribute(const std::string& name) const {
    if (!has_attribute(name)) fail("{}: attribute {}: missing", path_, name);
    Hdf5Id id(H5Aopen(id_.get(), name.c_str(), H5P_DEFAULT), H5Aclose);
    if (!id) fail("{}: attribute {}: cannot be read: {}", path_, name, reason());
    return id;
}

std::string Hdf5File::text(const std::string& name) const {
    const Quiet quiet;
    const Hdf5Id id = attribute(name);
    const Hdf5Id stored(H5Aget_type(id.get()), H5Tclose), extent(H5Aget_space(id.get()), H5Sclose);
    if (H5Tget_class(stored.get()) != H5T_STRING || H5Sget_simple_extent_npoints(extent.get()) != 1)
        fail("{}: attribute {}: expected a text", path_, name);
    const Hdf5Id memory(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_cset(memory.get(), H5Tget_cset(stored.get()));
    if (H5Tis_variable_str(stored.get()) > 0) {  // as h5py writes them
        H5Tset_size(memory.get(), H5T_VARIABLE);
        char* text = nullptr;
        if (H5Aread(id.get(), memory.get(), static_cast<void*>(&text)) < 0 || text == nullptr)
            fail("{}: attribute {}: cannot be read: {}", path_, name, reason());
        // cppcheck-suppress nullPointerRedundantCheck; fail() does not return
        std::string result(text);
        H5free_memory(text);
        return result;
    }
    std::string result(H5Tget_size(stored.get()) + 1, '\0');
    H5Tset_size(memory.get(), result.size());
    if (H5Aread(id.get(), memory.get(), result.data()) < 0)
        fail("{}: attribute {}: cannot be read: {}", path_, name, reason());
    result.resize(std::min(result.find('\0'), result.size()));
    return result;
}

std::vector<double> Hdf5File::numbers(const std::string& name, std::size_t count) const {
    const Quiet quiet;
    const Hdf5Id id = attribute(name);
    const Hdf5Id stored(H5Aget_type(id.get()), H5Tclose), extent(H5Aget_space(id.get()), H5Sclose);
    SampleType type{};
    const auto found = H5Sget_simple_extent_npoints(extent.get());
    if (!sample_type_of(stored.get(), type) || found < 0 || static_cast<std::size_t>(found) != count)
        fail("{}: attribute {}: expected {} number{}", path_, name, count, count == 1 ? "" : "s");
    std::vector<double> values(count);
    if (H5Aread(id.get(), H5T_NATIVE_DOUBLE, values.data()) < 0)
        fail("{}: attribute {}: cannot be read: {}", path_, name, reason());
    return values;
}

std::uint64_t Hdf5File::whole_number(const std::string& name) const {
    const Quiet quiet;
    const Hdf5Id id = attribute(name);
    const Hdf5Id stored(H5Aget_type(id.get()), H5Tclose), extent(H5Aget_space(id.get()), H5Sclose);
    std::uint64_t value = 0;
    if (H5Tget_class(stored.get()) != H5T_INTEGER || H5Sget_simple_extent_npoints(extent.get()) != 1)
        fail("{}: attribute {}: expected a whole number", path_, name);
    if (H5Aread(id.get(), H5T_NATIVE_UINT64, &value) < 0)
        fail("{}: attribute {}: cannot be read: {}", path_, name, reason());
    return value;
}

void Hdf5File::set_text(const std::string& name, const std::string& value) {
    const Quiet quiet;
    const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose), extent = space({});
    H5Tset_cset(type.get(), H5T_CSET_UTF8);
    H5Tset_size(type.get(), value.size() + 1);
    const Hdf5Id id(H5Acreate2(id_.get(), name.c_str(), type.get(), extent.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!id || H5Awrite(id.get(), type.get(), value.c_str()) < 0)
        fail("{}: attribute {}: cannot be written: {}", path_, name, reason());
}

void Hdf5File::set_numbers(const std::string& name, SampleType type, const Hdf5Extent& extent, const double* values) {
    const Quiet quiet;
    const Hdf5Id sizes = space(extent);
    const Hdf5Id id(H5Acreate2(id_.get(), name.c_str(), file_type(type), sizes.get(), H5P_DEFAULT, H5P_DEFAULT),
                    H5Aclose);
    if (!id || H5Awrite(id.get(), H5T_NATIVE_DOUBLE, values) < 0)
        fail("{}: attribute {}: cannot be written: {}", path_, name, reason());
}

void Hdf5File::set_whole_number(const std::string& name, std::uint64_t value) {
    const Quiet quiet;
    const Hdf5Id extent = space({});
    const Hdf5Id id(H5Acreate2(id_.get(), name.c_str(), H5T_STD_U64LE, extent.get(), H5P_DEFAULT, H5P_DEFAULT),
                    H5Aclose);
    if (!id || H5Awrite(id.get(), H5T_NATIVE_UINT64, &value) < 0)
        fail("{}: attribute {}: cannot be written: {}", path_, name, reason());
}

bool Hdf5File::has(const std::string& path) const {
    const Quiet quiet;
    // H5Lexists requires that every parent group exists.
    for (auto end = path.find('/', 1);; end = path.find('/', end + 1)) {
        if (H5Lexists(id_.get(), path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
        if (end == std::string::npos) return true;
    }
}

std::vector<std::string> Hdf5File::datasets() const {
    const Quiet quiet;
    std::vector<std::string> found;
    const auto visit = [](hid_t file, const char* name, const H5O_info_t* info, void* data) -> herr_t {
        if (info->type != H5O_TYPE_DATASET) return 0;
        const Hdf5Id dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
        if (!dataset) return 0;
        const Hdf5Id type(H5Dget_type(dataset.get()), H5Tclose);
        SampleType ignored{};
        if (type && sample_type_of(type.get(), ignored))
            static_cast<std::vector<std::string>*>(data)->push_back(std::string("/") + name);
        return 0;
    };
#if H5_VERSION_GE(1, 12, 0)
    const auto status = H5Ovisit3(id_.get(), H5_INDEX_NAME, H5_ITER_INC, visit, &found, H5O_INFO_BASIC);
#else
    const auto status = H5Ovisit2(id_.get(), H5_INDEX_NAME, H5_ITER_INC, visit, &found, H5O_INFO_BASIC);
#endif
    if (status < 0) fail("{}: its groups cannot be listed, the file is damaged: {}", path_, reason());
    return found;
}

std::vector<Hdf5File::ExternalLink> Hdf5File::external_links() const {
    const Quiet quiet;
    std::vector<ExternalLink> found;
    const auto visit = [](hid_t group, const char* name, const H5L_info_t* info, void* data) -> herr_t {
        constexpr std::size_t kMost = 65536;
        if (info->type != H5L_TYPE_EXTERNAL || info->u.val_size == 0 || info->u.val_size > kMost) return 0;
        std::string value(info->u.val_size, '\0');
        const char *file = nullptr, *object = nullptr;
        if (H5Lget_val(group, name, value.data(), value.size(), H5P_DEFAULT) >= 0 &&
            H5Lunpack_elink_val(value.data(), value.size(), nullptr, &file, &object) >= 0)
            static_cast<std::vector<ExternalLink>*>(data)->push_back({std::string("/") + name, file, object});
        return 0;
    };
    (void)H5Lvisit(id_.get(), H5_INDEX_NAME, H5_ITER_INC, visit, &found);
    return found;
}

std::optional<std::vector<double>> Hdf5File::find_numbers(const std::string& path, const std::string& name) const {
    const Quiet quiet;
    if (H5Aexists_by_name(id_.get(), path.c_str(), name.c_str(), H5P_DEFAULT) <= 0) return std::nullopt;
    const Hdf5Id id(H5Aopen_by_name(id_.get(), path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!id) return std::nullopt;
    const Hdf5Id stored(H5Aget_type(id.get()), H5Tclose), extent(H5Aget_space(id.get()), H5Sclose);
    SampleType type{};
    constexpr hssize_t kMost = 4096;
    const auto count = H5Sget_simple_extent_npoints(extent.get());
    if (!sample_type_of(stored.get(), type) || count < 1 || count > kMost) return std::nullopt;
    std::vector<double> values(static_cast<std::size_t>(count));
    if (H5Aread(id.get(), H5T_NATIVE_DOUBLE, values.data()) < 0) return std::nullopt;
    return values;
}

namespace {

/// The texts of an attribute or dataset, joined; nullopt if it holds none. `read(type, out)`: H5Aread or H5Dread.
template <typename Read>
std::optional<std::string> joined_texts(const Hdf5Id& stored, const Hdf5Id& extent, const Read& read) {
    constexpr hssize_t kMost = 65536;
    const auto count = H5Sget_simple_extent_npoints(extent.get());
    if (H5Tget_class(stored.get()) != H5T_STRING || count < 1 || count > kMost) return std::nullopt;
    std::string text;
    if (H5Tis_variable_str(stored.get()) > 0) {
        const Hdf5Id memory(H5Tcopy(stored.get()), H5Tclose);
        std::vector<char*> texts(static_cast<std::size_t>(count), nullptr);
        if (read(memory.get(), static_cast<void*>(texts.data())) < 0) return std::nullopt;
        for (const char* part : texts)
            if (part != nullptr) text += part;
        H5Dvlen_reclaim(memory.get(), extent.get(), H5P_DEFAULT, static_cast<void*>(texts.data()));
        return text;
    }
    const std::size_t size = H5Tget_size(stored.get());
    if (size < 1 || size > static_cast<std::size_t>(kMost)) return std::nullopt;
    std::string raw(size * static_cast<std::size_t>(count), '\0');
    if (read(stored.get(), static_cast<void*>(raw.data())) < 0) return std::nullopt;
    for (const char c : raw)
        if (c != '\0') text += c;
    return text;
}

}  // namespace

std::optional<std::string> Hdf5File::find_text(const std::string& path, const std::string& name) const {
    const Quiet quiet;
    if (H5Aexists_by_name(id_.get(), path.c_str(), name.c_str(), H5P_DEFAULT) <= 0) return std::nullopt;
    const Hdf5Id id(H5Aopen_by_name(id_.get(), path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!id) return std::nullopt;
    const Hdf5Id stored(H5Aget_type(id.get()), H5Tclose), extent(H5Aget_space(id.get()), H5Sclose);
    return joined_texts(stored, extent, [&](hid_t type, void* out) { return H5Aread(id.get(), type, out); });
}

std::string Hdf5File::text_dataset(const std::string& path) const {
    const Quiet quiet;
    if (!has(path)) fail("{}: {}: missing", path_, path);
    const Hdf5Id id(H5Dopen2(id_.get(), path.c_str(), H5P_DEFAULT), H5Dclose);
    std::optional<std::string> text;
    if (id) {
        const Hdf5Id stored(H5Dget_type(id.get()), H5Tclose), extent(H5Dget_space(id.get()), H5Sclose);
        text = joined_texts(stored, extent, [&](hid_t type, void* out) {
            return H5Dread(id.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out);
        });
    }
    if (!text) fail("{}: {}: expected a text", path_, path);
    return *text;
}

Hdf5Dataset Hdf5File::dataset(const std::string& path, std::size_t cache) const {
    const Quiet quiet;
    if (!has(path)) fail("{}: {}: missing", path_, path);
    Hdf5Dataset result;
    result.file_ = path_;
    result.name_ = path;
    const Hdf5Id access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
    constexpr std::size_t kSlots = 12421;  // slots of the cache's hash table: a prime, many times the number of chunks
    if (cache > 0) H5Pset_chunk_cache(access.get(), kSlots, cache, 1.0);
    result.id_ = Hdf5Id(H5Dopen2(id_.get(), path.c_str(), access.get()), H5Dclose);
    if (!result.id_) fail("{}: {}: not a dataset, or damaged: {}", path_, path, reason());
    const Hdf5Id type(H5Dget_type(result.id_.get()), H5Tclose), extent(H5Dget_space(result.id_.get()), H5Sclose);
    if (!sample_type_of(type.get(), result.type_)) fail("{}: {}: does not contain numbers", path_, path);
    result.extent_ = extent_of(extent.get());
    return result;
}

Hdf5Dataset Hdf5File::create_dataset(const std::string& path, const Hdf5Layout& layout) {
    const Quiet quiet;
    const Hdf5Id links(H5Pcreate(H5P_LINK_CREATE), H5Pclose), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.get(), 1);
    H5Pset_obj_track_times(creation.get(), false);  // equal volumes give equal files
    if (layout.chunk > 0) {
        std::vector<hsize_t> sides;  // clamped: HDF5 refuses chunks larger than the dataset
        for (const auto side : layout.extent)
            sides.push_back(std::min(side, layout.chunk));
        H5Pset_chunk(creation.get(), static_cast<int>(sides.size()), sides.data());
        H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER);
        if (layout.compress) {
            H5Pset_shuffle(creation.get());
            H5Pset_deflate(creation.get(), 1);
        }
    }
    const Hdf5Id extent = space(layout.extent);
    Hdf5Dataset result;
    result.file_ = path_;
    result.name_ = path;
    result.id_ = Hdf5Id(H5Dcreate2(id_.get(), path.c_str(), file_type(layout.type), extent.get(), links.get(),
                                   creation.get(), H5P_DEFAULT),
                        H5Dclose);
    if (!result.id_) fail("{}: {}: cannot be written: {}", path_, path, reason());
    result.extent_ = layout.extent;
    result.type_ = layout.type;
    return result;
}

}  // namespace edgesplat::detail
