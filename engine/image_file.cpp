#include "engine/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>

#include "engine/error.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

float srgb_encode(float linear) {
    return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

float srgb_decode(float encoded) {
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

/// 0..1 to 0..255, rounded; NaN and what lies below 0 become 0.
std::uint8_t to_byte(float value) {
    return value > 0 ? static_cast<std::uint8_t>(std::lround(std::min(value, 1.0F) * 255.0F)) : std::uint8_t{0};
}

/// Whether the last channel is alpha: Y and RGB have none, YA and RGBA do.
bool has_alpha(const Image& image) {
    return image.channels == 2 || image.channels == 4;
}

void check_image(const Image& image) {
    const bool sized = image.width > 0 && image.height > 0 && image.channels > 0;
    const std::size_t count = sized ? static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                                          static_cast<std::size_t>(image.channels)
                                    : 0;
    if (!sized || image.pixels.size() != count)
        fail("picture of {} x {} pixels and {} channels holds {} values", image.width, image.height, image.channels,
             image.pixels.size());
}

/// Runs an OpenImageIO writer into memory.
std::string encode(const char* format, OIIO::ImageSpec spec, const ImageMetadata& metadata, const void* pixels) {
    for (const auto& [name, text] : metadata)
        spec.attribute(name, text);
    OIIO::Filesystem::IOVecOutput memory;
    auto writer = OIIO::ImageOutput::create(format);
    if (!writer) fail("OpenImageIO cannot write {}: {}", format, OIIO::geterror());
    if (!writer->set_ioproxy(&memory)) fail("OpenImageIO cannot write {} to memory", format);
    const std::string name = std::string("memory.") + format;
    if (!writer->open(name, spec) || !writer->write_image(spec.format, pixels) || !writer->close())
        fail("cannot encode the picture as {}: {}", format, writer->geterror());
    return {memory.buffer().begin(), memory.buffer().end()};
}

/// While it lives, signals that would end the program are only noted; when it dies they take their course.
class DeferSignals {
  public:
    DeferSignals() {
        pending_ = 0;
        struct sigaction note {};
        note.sa_handler = [](int signal) { pending_ = signal; };
        sigemptyset(&note.sa_mask);
        note.sa_flags = SA_RESTART;
        for (std::size_t i = 0; i < kSignals.size(); ++i) {
            sigaction(kSignals[i], nullptr, &previous_[i]);
            if (previous_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &note, nullptr);
        }
    }
    ~DeferSignals() {
        for (std::size_t i = 0; i < kSignals.size(); ++i)
            sigaction(kSignals[i], &previous_[i], nullptr);
        if (pending_ != 0) raise(pending_);
    }
    DeferSignals(const DeferSignals&) = delete;
    DeferSignals& operator=(const DeferSignals&) = delete;

  private:
    static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
    static inline volatile std::sig_atomic_t pending_ = 0;
    std::array<struct sigaction, kSignals.size()> previous_{};
};

/// An open file under a temporary name beside its target; closed and removed unless renamed.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& target) : target_(target) {
        static std::atomic<unsigned> counter = 0;
        const std::string hidden = fmt::format(".{}.{}-{}.tmp", target.filename().string(), getpid(), counter++);
        name_ = (target.parent_path() / hidden).string();
        descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ >= 0) return;
        name_.clear();
        fail("cannot write {}: {}", target.string(), std::strerror(errno));
    }
    ~TemporaryFile() {
        if (descriptor_ >= 0) close(descriptor_);
        if (!name_.empty()) unlink(name_.c_str());
    }
    TemporaryFile(TemporaryFile&& other) noexcept
        : target_(std::move(other.target_)),
          name_(std::exchange(other.name_, {})),
          descriptor_(std::exchange(other.descriptor_, -1)) {}
    TemporaryFile& operator=(TemporaryFile&&) = delete;

    /// Writes everything and makes it last.
    void fill(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) fail("cannot write {}: {}", target_.string(), std::strerror(errno));
            bytes.remove_prefix(static_cast<std::size_t>(written));
        }
        const bool synced = fsync(descriptor_) == 0;
        const bool closed = close(std::exchange(descriptor_, -1)) == 0;
        if (!synced || !closed) fail("cannot write {}: {}", target_.string(), std::strerror(errno));
    }
    void rename_to_target() {
        if (std::rename(name_.c_str(), target_.c_str()) != 0)
            fail("cannot write {}: {}", target_.string(), std::strerror(errno));
        name_.clear();
    }

  private:
    fs::path target_;
    std::string name_;
    int descriptor_ = -1;
};

}  // namespace

bool is_png_path(const fs::path& path) {
    return lower_extension(path) == ".png";
}

void check_output_path(const fs::path& path, std::span<const std::string_view> extensions) {
    const std::string extension = lower_extension(path);
    if (!extensions.empty() && std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
        fail("cannot write {}: its name must end in {}", path.string(), fmt::join(extensions, " or "));
    std::error_code ignored;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored))
        fail("cannot write {}: the folder {} does not exist", path.string(), folder.string());
    if (fs::is_directory(path, ignored)) fail("cannot write {}: it is a folder", path.string());
    const TemporaryFile probe(path);
}

std::string encode_png(const Image& image, const ImageMetadata& metadata) {
    check_image(image);
    if (image.channels > 4) fail("a PNG has 1 to 4 channels, not {}", image.channels);
    const auto channels = static_cast<std::size_t>(image.channels);
    std::vector<std::uint8_t> bytes(image.pixels.size());
    for (std::size_t pixel = 0; pixel < bytes.size(); pixel += channels) {
        const std::size_t colors = has_alpha(image) ? channels - 1 : channels;
        const float alpha = has_alpha(image) ? image.pixels[pixel + colors] : 1.0F;
        for (std::size_t c = 0; c < colors; ++c) {
            const float straight = alpha > 0 ? image.pixels[pixel + c] / alpha : 0.0F;
            bytes[pixel + c] = to_byte(srgb_encode(straight));
        }
        if (has_alpha(image)) bytes[pixel + colors] = to_byte(alpha);
    }
    OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeDesc::UINT8);
    if (has_alpha(image)) spec.alpha_channel = image.channels - 1;
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("oiio:ColorSpace", "sRGB");
    return encode("png", spec, metadata, bytes.data());
}

std::string encode_exr(std::span<const ImageLayer> layers, const ImageMetadata& metadata) {
    if (layers.empty()) fail("an EXR file needs at least one layer");
    const Image& first = *layers.front().image;
    std::vector<std::string> names;
    for (const ImageLayer& layer : layers) {
        check_image(*layer.image);
        if (layer.image->width != first.width || layer.image->height != first.height)
            fail("the layers of an EXR file differ in size");
        if (layer.channel_names.size() != static_cast<std::size_t>(layer.image->channels))
            fail("{} channel names for {} channels", layer.channel_names.size(), layer.image->channels);
        names.insert(names.end(), layer.channel_names.begin(), layer.channel_names.end());
    }
    Image all(first.width, first.height, static_cast<int>(names.size()));
    int offset = 0;
    for (const ImageLayer& layer : layers) {
        for (int y = 0; y < all.height; ++y)
            for (int x = 0; x < all.width; ++x)
                for (int c = 0; c < layer.image->channels; ++c)
                    all.at(x, y, offset + c) = layer.image->at(x, y, c);
        offset += layer.image->channels;
    }
    OIIO::ImageSpec spec(all.width, all.height, all.channels, OIIO::TypeDesc::FLOAT);
    spec.channelnames = names;
    const auto alpha = std::find(names.begin(), names.end(), "A");
    spec.alpha_channel = alpha == names.end() ? -1 : static_cast<int>(alpha - names.begin());
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    return encode("exr", spec, metadata, all.pixels.data());
}

void write_files(std::span<const FileContent> files) {
    const DeferSignals defer;
    std::vector<TemporaryFile> temporary;
    temporary.reserve(files.size());
    for (const FileContent& file : files) {
        temporary.emplace_back(file.path);
        temporary.back().fill(file.bytes);
    }
    for (TemporaryFile& file : temporary)
        file.rename_to_target();
}

void write_image(const fs::path& path, const Image& image, const ImageMetadata& metadata) {
    static constexpr std::array<std::string_view, 2> kExtensions{".png", ".exr"};
    check_output_path(path, kExtensions);
    FileContent file{path, {}};
    if (is_png_path(path)) {
        file.bytes = encode_png(image, metadata);
    } else {
        static const std::array<std::vector<std::string>, 4> kNames{
            {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};
        if (image.channels < 1 || image.channels > 4) fail("a picture has 1 to 4 channels, not {}", image.channels);
        const ImageLayer layer{&image, kNames[static_cast<std::size_t>(image.channels) - 1]};
        file.bytes = encode_exr({&layer, 1}, metadata);
    }
    write_files({&file, 1});
}

LoadedImage read_image(const fs::path& path) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) fail("{}: no such file", path.string());
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);  // PNG alpha as stored; it is multiplied in below, in linear light
    const auto reader = OIIO::ImageInput::open(path.string(), &config);
    if (!reader) fail("{}: cannot be read as a picture: {}", path.string(), OIIO::geterror());
    const OIIO::ImageSpec spec = reader->spec();
    LoadedImage loaded{Image(spec.width, spec.height, spec.nchannels), spec.channelnames, {}};
    if (!reader->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, loaded.image.pixels.data()))
        fail("{}: cannot be read: {}", path.string(), reader->geterror());
    for (const OIIO::ParamValue& attribute : spec.extra_attribs)
        if (attribute.type() == OIIO::TypeString)
            loaded.metadata.emplace_back(attribute.name().string(), attribute.get_string());
    if (spec.format.is_floating_point()) return loaded;

    const auto channels = static_cast<std::size_t>(spec.nchannels);
    const auto alpha_channel = static_cast<std::size_t>(spec.alpha_channel);
    for (std::size_t pixel = 0; pixel < loaded.image.pixels.size(); pixel += channels) {
        const float alpha = spec.alpha_channel >= 0 ? loaded.image.pixels[pixel + alpha_channel] : 1.0F;
        for (std::size_t c = 0; c < channels; ++c) {
            float& value = loaded.image.pixels[pixel + c];
            if (spec.alpha_channel < 0 || c != alpha_channel) value = srgb_decode(value) * alpha;
        }
    }
    return loaded;
}

}  // namespace edgesplat
