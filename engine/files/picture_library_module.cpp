// The OpenImageIO module (engine/files/picture_library_internal.h).
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>

#include "engine/error.h"
#include "engine/files/picture_library_internal.h"

namespace edgesplat {
namespace {

using detail::SampleType;

struct TypePair {
    SampleType ours;
    OIIO::TypeDesc::BASETYPE theirs;
};
/// Types in order of preference: the first match of a SampleType is requested.
constexpr TypePair kTypes[] = {
    {SampleType::Int8, OIIO::TypeDesc::INT8},     {SampleType::UInt8, OIIO::TypeDesc::UINT8},
    {SampleType::Int16, OIIO::TypeDesc::INT16},   {SampleType::UInt16, OIIO::TypeDesc::UINT16},
    {SampleType::Int32, OIIO::TypeDesc::INT32},   {SampleType::UInt32, OIIO::TypeDesc::UINT32},
    {SampleType::Int64, OIIO::TypeDesc::INT64},   {SampleType::UInt64, OIIO::TypeDesc::UINT64},
    {SampleType::Float32, OIIO::TypeDesc::FLOAT}, {SampleType::Float32, OIIO::TypeDesc::HALF},
    {SampleType::Float64, OIIO::TypeDesc::DOUBLE}};

std::optional<SampleType> sample_type_of(const OIIO::TypeDesc& format) {
    const auto* found = std::ranges::find(kTypes, format.basetype, &TypePair::theirs);
    return found == std::end(kTypes) ? std::nullopt : std::optional(found->ours);
}

OIIO::TypeDesc type_desc(SampleType type) {
    return std::ranges::find(kTypes, type, &TypePair::ours)->theirs;
}

class Reader : public PictureReader {
  public:
    explicit Reader(std::unique_ptr<OIIO::ImageInput> input) : input_(std::move(input)) {}

    bool seek(int page) override { return input_->seek_subimage(page, 0); }

    PicturePage page() const override {
        const OIIO::ImageSpec spec = input_->spec();
        PicturePage page{.width = spec.width,
                         .height = spec.height,
                         .depth = spec.depth,
                         .channels = spec.nchannels,
                         .alpha_channel = spec.alpha_channel,
                         .type = sample_type_of(spec.format),
                         .type_name = spec.format.c_str(),
                         .bits = spec.get_int_attribute("oiio:BitsPerSample", 8),
                         .channel_names = spec.channelnames,
                         .texts = {}};
        for (const OIIO::ParamValue& attribute : spec.extra_attribs)
            if (attribute.type() == OIIO::TypeString)
                page.texts.emplace_back(attribute.name().string(), attribute.get_string());
        return page;
    }

    bool read(int page, SampleType type, void* samples) override {
        return input_->read_image(page, 0, 0, -1, type_desc(type), samples);
    }

    std::string take_error() override { return input_->geterror(); }

  private:
    std::unique_ptr<OIIO::ImageInput> input_;
};

class Library : public PictureLibrary {
  public:
    std::unique_ptr<PictureReader> open(const std::string& path, std::string& reason) const override {
        OIIO::ImageSpec config;
        config["oiio:UnassociatedAlpha"] = 1;
        auto input = OIIO::ImageInput::open(path, &config);
        if (input) return std::make_unique<Reader>(std::move(input));
        reason = OIIO::geterror();
        return nullptr;
    }

    std::string encode_exr(const PictureSpec& picture, const float* pixels) const override {
        const auto channels = static_cast<int>(picture.channel_names.size());
        OIIO::ImageSpec spec(picture.width, picture.height, channels, OIIO::TypeDesc::FLOAT);
        spec.channelnames = picture.channel_names;
        spec.alpha_channel = picture.alpha_channel;
        spec.attribute("compression", "zip");
        spec.attribute("oiio:ColorSpace", "Linear");
        for (const auto& [name, text] : picture.texts)
            spec.attribute(name, text);
        OIIO::Filesystem::IOVecOutput memory;
        auto writer = OIIO::ImageOutput::create("exr");
        if (!writer) fail("OpenImageIO cannot write exr: {}", OIIO::geterror());
        if (!writer->set_ioproxy(&memory)) fail("OpenImageIO cannot write exr to memory");
        if (!writer->open("memory.exr", spec) || !writer->write_image(spec.format, pixels) || !writer->close())
            fail("cannot encode the picture as exr: {}", writer->geterror());
        return {memory.buffer().begin(), memory.buffer().end()};
    }

    std::optional<glm::ivec2> text_size(const std::string& text, int height, const char* font) const override {
        const OIIO::ROI box = OIIO::ImageBufAlgo::text_size(text, height, font);
        if (!box.defined()) return std::nullopt;
        return glm::ivec2(box.width(), box.height());
    }

    std::optional<TextMask> text(const std::string& text, int height, const char* font) const override {
        const OIIO::ROI box = OIIO::ImageBufAlgo::text_size(text, height, font);
        if (!box.defined()) return std::nullopt;
        TextMask mask{box.width() + 2, box.height() + 2, {}};
        OIIO::ImageBuf pixels(OIIO::ImageSpec(mask.width, mask.height, 1, OIIO::TypeDesc::FLOAT));
        OIIO::ImageBufAlgo::zero(pixels);
        const float white = 1;
        if (!OIIO::ImageBufAlgo::render_text(pixels, 1 - box.xbegin, 1 - box.ybegin, text, height, font, {&white, 1}))
            fail("overlays: '{}' cannot be drawn: {}", text, pixels.geterror());
        mask.coverage.reserve(static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height));
        for (int y = 0; y < mask.height; ++y)
            for (int x = 0; x < mask.width; ++x)
                mask.coverage.push_back(pixels.getchannel(x, y, 0, 0));
        return mask;
    }
};

}  // namespace
}  // namespace edgesplat

extern "C" __attribute__((visibility("default"))) const edgesplat::PictureLibrary* edgesplat_picture_library() {
    static const edgesplat::Library library;
    return &library;
}
