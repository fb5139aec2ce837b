// Reads and writes image files. Files are written atomically.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/image/image.h"

namespace edgesplat {

/// Text stored in an image file: PNG text chunks, EXR string attributes. The command line tool writes the names
/// "edgesplat:command", "edgesplat:volume", "edgesplat:checksum", "edgesplat:renderer", "edgesplat:device",
/// "edgesplat:scene" (the picture's complete scene as TOML) and "Software".
using ImageMetadata = std::vector<std::pair<std::string, std::string>>;

/// An image with named channels. An EXR file may contain several of the same size (R,G,B,A, depth.Z, normal.X, ...).
struct ImageLayer {
    const Image* image = nullptr;
    std::vector<std::string> channel_names;  ///< one per channel of the image
};

/// The path and content of a file to write.
struct FileContent {
    std::filesystem::path path;
    std::string bytes;
};

/// Whether the name ends in .png, in upper or lower case.
bool is_png_path(const std::filesystem::path& path);

/// Checks before rendering that the file can be written. Throws Error if the folder is missing or not writable, the
/// path is a folder, or the extension is not in `extensions` (empty: any).
void check_output_path(const std::filesystem::path& path, std::span<const std::string_view> extensions = {});

/// The colours of an RGBA image: what a PNG of a rendered picture shows, background included.
Image without_alpha(const Image& image);

/// Throws Error if size, channels and number of values are inconsistent.
void check_image(const Image& image);

/// Encodes an 8-bit PNG: sRGB, colour divided by alpha (PNG's convention), clamped to 0..1, NaN as 0. 1 to 4 channels:
/// Y, YA, RGB, RGBA. Throws Error.
std::string encode_png(const Image& image, const ImageMetadata& metadata);

/// Encodes a float32 EXR, linear, zip-compressed. Throws Error.
std::string encode_exr(std::span<const ImageLayer> layers, const ImageMetadata& metadata);

/// Writes all files or none. Each is written under a temporary name in its own folder and synced to disk. When all are
/// complete, they are renamed and replace existing files. SIGINT, SIGTERM and SIGHUP are deferred until then. On
/// failure the temporary files are removed. Throws Error.
void write_files(std::span<const FileContent> files);

/// Writes one image in the format of its extension. Throws Error.
void write_image(const std::filesystem::path& path, const Image& image, const ImageMetadata& metadata = {});

struct LoadedImage {
    Image image;
    std::vector<std::string> channel_names;
    ImageMetadata metadata;  ///< all texts of the file
};

/// Reads an image of any OpenImageIO format into linear light: integer pixels are interpreted as sRGB, floating-point
/// ones as linear; colour is multiplied by alpha. Throws Error.
LoadedImage read_image(const std::filesystem::path& path);

}  // namespace edgesplat
