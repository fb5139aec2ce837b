// Reads stacks and sequences of images: TIFF by the reader of TIFF, pictures that OpenImageIO changes by our own, all
// others through it. Samples as stored, not scaled to 0..1.
#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <memory>
#include <optional>
#include <span>

#include "engine/files/picture_library_internal.h"
#include "engine/volume/io/exact_pictures.h"
#include "engine/volume/io/readers.h"
#include "engine/volume/io/tiff.h"

namespace edgesplat::detail {
namespace {

std::string first_part(const std::string& path) {
    std::string head(8, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(file.gcount()));
    return head;
}

std::unique_ptr<PictureReader> opened(const std::string& path) {
    if (auto exact = open_exact_picture(path)) return exact;
    const std::string head = first_part(path);
    if (path.ends_with(".tga") && head.size() > 2 && head[1] == 1 && (head[2] == 1 || head[2] == 9))
        fail("{}: a TGA with a palette, whose indices are not read; save it as PNG", path);
    std::string reason;
    std::unique_ptr<PictureReader> input;
    {
        OutputCapture capture;
        input = picture_library().open(path, reason);
    }
    if (!input) fail("{}: cannot be read as an image: {}", path, tidy(reason));
    return input;
}

/// Whether the samples are single bits; OpenImageIO does not report this for portable bitmaps.
bool holds_bits(const PicturePage& page, const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    char head[2] = {};
    file.read(head, sizeof head);
    return page.bits == 1 || (head[0] == 'P' && (head[1] == '1' || head[1] == '4'));
}

// The last number in a file name, and the name without it.
struct NumberedName {
    std::string file, stem;
    std::optional<unsigned long long> number;
};

NumberedName numbered(const std::string& file) {
    const auto name = std::filesystem::path(file).filename().string();
    const auto dot = name.rfind('.');
    auto end = dot == std::string::npos ? name.size() : dot;
    while (end > 0 && std::isdigit(static_cast<unsigned char>(name[end - 1])) == 0)
        --end;
    auto begin = end;
    while (begin > 0 && end - begin < 18 && std::isdigit(static_cast<unsigned char>(name[begin - 1])) != 0)
        --begin;
    if (begin == end) return {file, name, std::nullopt};
    return {file, name.substr(0, begin) + "#" + name.substr(end), std::stoull(name.substr(begin, end - begin))};
}

}  // namespace

bool is_image_file(const std::string& path) {
    if (begins_as_exact_picture(first_part(path))) return true;
    OutputCapture capture;
    std::string ignored;
    return picture_library().open(path, ignored) != nullptr;
}

std::vector<std::string> ordered_slices(const std::string& name, std::vector<std::string> files,
                                        std::vector<std::string>& notes) {
    if (files.size() == 1) return files;
    std::vector<NumberedName> names;
    for (const auto& file : files)
        names.push_back(numbered(file));
    std::sort(names.begin(), names.end(), [](const NumberedName& a, const NumberedName& b) {
        return a.number != b.number ? a.number < b.number : a.file < b.file;
    });
    files.clear();
    for (const auto& entry : names) {
        if (!entry.number)
            fail("{}: {} has no number in its name, so its place among the slices is unknown", name, entry.file);
        if (entry.stem != names[0].stem)
            fail("{}: {} and {} do not belong to one sequence; name the slices by a pattern such as slice_%03d.png",
                 name, names[0].file, entry.file);
        files.push_back(entry.file);
    }
    const auto step = *names[1].number - *names[0].number;
    for (std::size_t i = 1; i < names.size(); ++i) {
        const auto here = *names[i].number - *names[i - 1].number;
        if (here == 0) fail("{}: {} and {} have the same number", name, names[i - 1].file, names[i].file);
        if (here != step)
            fail("{}: the numbers of {} and {} differ by {}, the earlier ones by {}: a slice is missing", name,
                 names[i - 1].file, names[i].file, here, step);
    }
    if (step > 1) notes.push_back(fmt::format("The slices are numbered in steps of {}.", step));
    return files;
}

Volume load_images(const std::string& name, const std::vector<std::string>& files, const LoadOptions& options) {
    if (begins_as_tiff(first_part(files[0]))) return load_tiff(name, files, options);
    Volume volume;
    volume.name = name;
    const bool stack = files.size() == 1;
    int width = 0, height = 0, channels = 0;
    std::optional<SampleType> type;
    std::size_t component = 0, depth = 0;
    (void)chosen_frame(name, options, 1);
    std::vector<unsigned char> buffer;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const auto input = opened(files[i]);
        int pages = 1;
        if (stack) {
            OutputCapture capture;
            while (input->seek(pages))
                ++pages;
            (void)input->take_error();
        } else {
            OutputCapture capture;
            if (input->seek(1)) pages = 2;
            (void)input->take_error();
        }
        if (!stack && pages > 1)
            fail("{}: {} holds several images: a stack can only be read by itself", name, files[i]);
        for (int page = 0; page < pages; ++page) {
            const std::size_t slices = stack ? static_cast<std::size_t>(pages) : files.size();
            report(options, 0.9 * static_cast<double>(depth) / static_cast<double>(slices), "reading images");
            std::string reason;
            bool read = false;
            {
                OutputCapture capture;
                input->seek(page);
            }
            const PicturePage spec = input->page();
            const auto here = stack ? fmt::format("page {} of {}", page, files[i]) : files[i];
            if (spec.depth > 1) fail("{}: a tiled 3-D image, which cannot be read; save it as a stack of pages", here);
            if (!spec.type) fail("{}: pixels of type {} cannot be read", files[i], spec.type_name);
            const SampleType here_type = *spec.type;
            if (!type) {
                type = here_type;
                width = spec.width;
                height = spec.height;
                channels = spec.channels;
                component = chosen_component(name, options, static_cast<std::size_t>(channels));
                checked_bytes(name, {static_cast<std::size_t>(width), static_cast<std::size_t>(height), slices},
                              sizeof(float));
                // Only one page is unpacked at a time, with all its channels.
                const std::size_t page_bytes = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                               static_cast<std::size_t>(channels) * size_of(here_type);
                check_memory(name, fmt::format("pages of {} x {} pixels, {} channels", width, height, channels),
                             page_bytes);
                check_stored_size(name, page_bytes, std::filesystem::file_size(files[i]), kBestPictureRatio);
                if (std::ranges::find(spec.texts, "palette", &std::pair<std::string, std::string>::first) !=
                    spec.texts.end())
                    volume.notes.emplace_back("A palette image: samples are its indices, not its colours.");
                volume.values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * slices);
                if (spec.bits % 8 != 0 && spec.bits != 1)
                    volume.notes.push_back(fmt::format(
                        "Samples of {} bits are scaled up to the next whole byte by OpenImageIO.", spec.bits));
            }
            if (spec.width != width || spec.height != height || spec.channels != channels || here_type != *type)
                fail("{}: {} has {} x {} pixels, {} channels, {}; the slices before it {} x {}, {}, {}", name, here,
                     spec.width, spec.height, spec.channels, name_of(here_type), width, height, channels,
                     name_of(*type));
            const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
            buffer.resize(pixels * static_cast<std::size_t>(channels) * size_of(*type));
            {
                OutputCapture capture;
                read = input->read(page, *type, buffer.data());
                reason = input->take_error();
            }
            if (!read) fail("{}: truncated or damaged: {}", here, tidy(reason));
            convert_samples(*type, buffer.data(), component, static_cast<std::size_t>(channels), pixels,
                            volume.values.data() + depth * pixels);
            // OpenImageIO scales bits to whole bytes; a mask becomes 0 and 1.
            if (holds_bits(spec, files[i]))
                for (float& value : std::span(volume.values).subspan(depth * pixels, pixels))
                    value = value > 0 ? 1.0F : 0.0F;
            ++depth;
        }
    }
    volume.stored_type = name_of(*type);
    volume.geometry.dims = {width, height, static_cast<int>(depth)};
    volume.geometry_source = "none: 1 mm assumed";
    if (depth == 1) volume.notes.push_back("The file holds one image: it is read as a volume of one slice.");
    if (!options.spacing)
        volume.notes.push_back(
            "Images do not contain a slice spacing: 1 x 1 x 1 mm is assumed; give "
            "--spacing X Y Z.");
    return volume;
}

}  // namespace edgesplat::detail
