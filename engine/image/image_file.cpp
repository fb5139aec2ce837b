#include "engine/image/image_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

#include "engine/error.h"
#include "engine/files/picture_library_internal.h"
#include "engine/image/srgb.h"
#include "footprints/temporary_file.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

/// Calls `step`, which writes `target`, and converts its errors.
template <typename Step>
auto writing(const fs::path& target, const Step& step) {
    try {
        return step();
    } catch (const std::system_error& error) {
        fail("cannot write {}: {}", target.string(), error.code().message());
    }
}

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
    const DeferSignals defer;
    writing(path, [&] { const TemporaryFile probe(path); });
}

Image without_alpha(const Image& image) {
    Image out(image.width, image.height, 3);
    for (std::size_t i = 0; i < out.pixels.size() / 3; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            out.pixels[3 * i + c] = image.pixels[4 * i + c];
    return out;
}

void check_image(const Image& image) {
    const bool sized = image.width > 0 && image.height > 0 && image.channels > 0;
    const std::size_t count = sized ? static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                                          static_cast<std::size_t>(image.channels)
                                    : 0;
    if (!sized || image.pixels.size() != count)
        fail("picture of {} x {} pixels and {} channels has {} values", image.width, image.height, image.channels,
             image.pixels.size());
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
    PictureSpec spec{.width = all.width, .height = all.height, .channel_names = names, .texts = metadata};
    const auto alpha = std::find(names.begin(), names.end(), "A");
    if (alpha != names.end()) spec.alpha_channel = static_cast<int>(alpha - names.begin());
    return picture_library().encode_exr(spec, all.pixels.data());
}

void write_files(std::span<const FileContent> files) {
    const DeferSignals defer;
    std::vector<TemporaryFile> temporary;
    temporary.reserve(files.size());
    for (const FileContent& file : files)
        writing(file.path, [&] {
            temporary.emplace_back(file.path);
            temporary.back().write(file.bytes);
            temporary.back().sync();
        });
    for (TemporaryFile& file : temporary)
        writing(fs::path(file.target()), [&] { file.rename_to_target(); });
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
    std::string reason;
    const auto reader = picture_library().open(path.string(), reason);
    if (!reader) fail("{}: cannot be read as a picture: {}", path.string(), reason);
    const PicturePage spec = reader->page();
    // Checked before allocation: no image compression exceeds this ratio.
    constexpr std::size_t kBestRatio = std::size_t{1} << 16;
    const std::size_t stored = fs::file_size(path, ignored);
    const auto samples = static_cast<double>(spec.width) * spec.height * spec.channels;
    if (!(samples > 0) ||
        samples * sizeof(float) > static_cast<double>(kBestRatio) * static_cast<double>(stored + 4096))
        fail("{}: truncated or damaged: {} x {} pixels with {} channels cannot be in {} bytes", path.string(),
             spec.width, spec.height, spec.channels, stored);
    LoadedImage loaded{Image(spec.width, spec.height, spec.channels), spec.channel_names, spec.texts};
    if (!reader->read(0, detail::SampleType::Float32, loaded.image.pixels.data()))
        fail("{}: cannot be read: {}", path.string(), reader->take_error());
    if (spec.type == detail::SampleType::Float32 || spec.type == detail::SampleType::Float64) return loaded;

    // Alpha is as stored; colour is multiplied by it here, in linear light.
    const auto channels = static_cast<std::size_t>(spec.channels);
    const auto alpha_channel = static_cast<std::size_t>(spec.alpha_channel);
    for (std::size_t pixel = 0; pixel < loaded.image.pixels.size(); pixel += channels) {
        const float alpha = spec.alpha_channel >= 0 ? loaded.image.pixels[pixel + alpha_channel] : 1.0F;
        for (std::size_t c = 0; c < channels; ++c) {
            float& value = loaded.image.pixels[pixel + c];
            if (spec.alpha_channel < 0 || c != alpha_channel) value = to_linear(value) * alpha;
        }
    }
    return loaded;
}

}  // namespace edgesplat
