// Pictures to and from files. A file appears whole or not at all.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/image/image.h"

namespace edgesplat {

/// Text that travels with a picture: PNG text chunks, EXR string attributes. Names the command line tool writes:
/// "edgesplat:command", "edgesplat:volume", "edgesplat:checksum", "edgesplat:renderer", "edgesplat:device",
/// "edgesplat:scene" (the picture's scene as TOML, with nothing left open) and "Software".
using ImageMetadata = std::vector<std::pair<std::string, std::string>>;

/// Channels under their names, all of one size; an EXR file may hold several (R,G,B,A, depth.Z, normal.X, ...).
struct ImageLayer {
    const Image* image = nullptr;
    std::vector<std::string> channel_names;  ///< as many as the image has channels
};

/// A file that is ready to be written.
struct FileContent {
    std::filesystem::path path;
    std::string bytes;
};

/// Whether the name ends in .png, in any case.
bool is_png_path(const std::filesystem::path& path);

/// Refuses, before anything is computed, a file that could not be written afterwards. Throws Error: the folder is
/// missing or not writable, the path is a folder, or its ending is none of `extensions` (empty: any).
void check_output_path(const std::filesystem::path& path, std::span<const std::string_view> extensions = {});

/// The colours of an RGBA picture. What a PNG shows of a rendered one: what is seen, the background included.
Image without_alpha(const Image& image);

/// Throws Error where the size, the channels and the number of values do not go together.
void check_image(const Image& image);

/// An 8-bit PNG: sRGB-encoded, colour divided by alpha (PNG's convention), clamped to 0..1, NaN as 0.
/// 1 to 4 channels: Y, YA, RGB, RGBA. Throws Error.
std::string encode_png(const Image& image, const ImageMetadata& metadata);

/// A float32 EXR, linear, zip-compressed. Throws Error.
std::string encode_exr(std::span<const ImageLayer> layers, const ImageMetadata& metadata);

/// Writes all files, or none: each goes under a temporary name in its own folder first, is synced to disk, and only
/// when all are there they are renamed, replacing what stood under their names. SIGINT, SIGTERM and SIGHUP wait until
/// this is over. On failure the temporary files are removed. Throws Error.
void write_files(std::span<const FileContent> files);

/// Writes one picture by the ending of its name. Throws Error.
void write_image(const std::filesystem::path& path, const Image& image, const ImageMetadata& metadata = {});

struct LoadedImage {
    Image image;
    std::vector<std::string> channel_names;
    ImageMetadata metadata;  ///< every text in the file
};

/// Reads a picture of any format OpenImageIO knows into linear light: integer pixels are taken as sRGB, floating-point
/// ones as linear; colour is multiplied by alpha. Throws Error.
LoadedImage read_image(const std::filesystem::path& path);

}  // namespace edgesplat
