// OpenImageIO, behind a module: it brings some 250 shared libraries, a quarter of a second of every program's start, so
// it is loaded by the first picture that needs it.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/files/sample_type_internal.h"

namespace edgesplat {

/// What a page of a file holds.
struct PicturePage {
    int width = 0, height = 0, depth = 0, channels = 0;
    int alpha_channel = -1;                  ///< -1: none
    std::optional<detail::SampleType> type;  ///< half floats as Float32; none: of a type that cannot be read
    std::string type_name;                   ///< in OpenImageIO's words
    int bits = 8;                            ///< of a sample, as stored
    std::vector<std::string> channel_names;
    std::vector<std::pair<std::string, std::string>> texts;
};

/// An open file; alpha as stored, colours not multiplied by it.
class PictureReader {
  public:
    PictureReader() = default;
    PictureReader(const PictureReader&) = delete;
    PictureReader& operator=(const PictureReader&) = delete;
    virtual ~PictureReader() = default;
    /// Makes a page the current one, from 0. Whether there is one.
    virtual bool seek(int page) = 0;
    virtual PicturePage page() const = 0;
    /// All samples of a page, (height, width, channels). Whether they could be read.
    virtual bool read(int page, detail::SampleType type, void* samples) = 0;
    /// What went wrong since the last call; empty: nothing.
    virtual std::string take_error() = 0;
};

/// What is to be written: float channels in linear light.
struct PictureSpec {
    int width = 0, height = 0;
    std::vector<std::string> channel_names;
    int alpha_channel = -1;
    std::vector<std::pair<std::string, std::string>> texts;
};

/// A text, drawn: how much of each pixel it covers, 0..1, (height, width).
struct TextMask {
    int width = 0, height = 0;
    std::vector<float> coverage;
};

class PictureLibrary {
  public:
    PictureLibrary() = default;
    PictureLibrary(const PictureLibrary&) = delete;
    PictureLibrary& operator=(const PictureLibrary&) = delete;
    virtual ~PictureLibrary() = default;
    /// Null: it cannot be read, and `reason` says why.
    virtual std::unique_ptr<PictureReader> open(const std::string& path, std::string& reason) const = 0;
    /// A zip-compressed EXR file's bytes, of (height, width, channels) pixels. Throws Error.
    virtual std::string encode_exr(const PictureSpec& spec, const float* pixels) const = 0;
    /// Width and height, pixels; none where the font cannot be found.
    virtual std::optional<glm::ivec2> text_size(const std::string& text, int height, const char* font) const = 0;
    /// With a margin of a pixel; none where the font cannot be found. Throws Error.
    virtual std::optional<TextMask> text(const std::string& text, int height, const char* font) const = 0;
};

/// Loads the module when first called. Throws Error where it cannot be loaded.
const PictureLibrary& picture_library();

/// Name of the function that the module exports: `const PictureLibrary* edgesplat_picture_library()`.
inline constexpr const char* kPictureLibraryEntry = "edgesplat_picture_library";

}  // namespace edgesplat
