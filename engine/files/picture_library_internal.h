// Interface to OpenImageIO, which is in a separate module. It depends on about 250 shared libraries, which take a
// quarter of a second to load. The module is therefore loaded only when a picture needs it.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/files/sample_type_internal.h"

namespace edgesplat {

/// Description of a page of an image file.
struct PicturePage {
    int width = 0, height = 0, depth = 0, channels = 0;
    int alpha_channel = -1;                  ///< -1: none
    std::optional<detail::SampleType> type;  ///< half floats are Float32; none: unsupported type
    std::string type_name;                   ///< OpenImageIO's name of the type
    int bits = 8;                            ///< bits per stored sample
    std::vector<std::string> channel_names;
    std::vector<std::pair<std::string, std::string>> texts;
};

/// An open file. Alpha is as stored; colours are not multiplied by it.
class PictureReader {
  public:
    PictureReader() = default;
    PictureReader(const PictureReader&) = delete;
    PictureReader& operator=(const PictureReader&) = delete;
    virtual ~PictureReader() = default;
    /// Selects a page, from 0. Returns whether it exists.
    virtual bool seek(int page) = 0;
    virtual PicturePage page() const = 0;
    /// Reads all samples of a page, (height, width, channels). Returns whether this succeeded.
    virtual bool read(int page, detail::SampleType type, void* samples) = 0;
    /// Errors since the last call; empty: none.
    virtual std::string take_error() = 0;
};

/// Description of a picture to write: float channels in linear light.
struct PictureSpec {
    int width = 0, height = 0;
    std::vector<std::string> channel_names;
    int alpha_channel = -1;
    std::vector<std::pair<std::string, std::string>> texts;
};

/// A rasterised text: coverage of each pixel, 0..1, (height, width).
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
    /// Opens a file. Null if it cannot be read; `reason` then holds the cause.
    virtual std::unique_ptr<PictureReader> open(const std::string& path, std::string& reason) const = 0;
    /// Encodes (height, width, channels) pixels as a zip-compressed EXR file. Throws Error.
    virtual std::string encode_exr(const PictureSpec& spec, const float* pixels) const = 0;
    /// Width and height of the text, pixels; none if the font is missing.
    virtual std::optional<glm::ivec2> text_size(const std::string& text, int height, const char* font) const = 0;
    /// Rasterises the text with a margin of one pixel; none if the font is missing. Throws Error.
    virtual std::optional<TextMask> text(const std::string& text, int height, const char* font) const = 0;
};

/// The module, loaded at the first call. Throws Error if it cannot be loaded.
const PictureLibrary& picture_library();

/// Name of the function that the module exports: `const PictureLibrary* edgesplat_picture_library()`.
inline constexpr const char* kPictureLibraryEntry = "edgesplat_picture_library";

}  // namespace edgesplat
