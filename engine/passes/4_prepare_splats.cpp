#include "engine/passes/4_prepare_splats.h"

#include <algorithm>
#include <bit>

namespace edgesplat::passes {

namespace {

bool cuts_at_faces(const DrawVariant& variant) {
    return variant.footprints != FootprintMode::Isotropic && variant.warp == WarpFamily::Face;
}

}  // namespace

std::uint32_t prepared_stride(const DrawVariant& variant) {
    std::uint32_t vectors = 4;  // conic, start, colour
    if (variant.footprints != FootprintMode::Isotropic) vectors += cuts_at_faces(variant) ? 4 : 2;
    if (variant.creases) vectors += 1;
    if (variant.sliced) vectors += 1;
    if (variant.clip.keep + variant.clip.remove > 0) vectors += 2;
    if (variant.antialias) vectors += 2;
    if (variant.footprints == FootprintMode::Table) vectors += 2;
    return vectors;
}

glm::ivec2 prepared_size(const DrawVariant& variant, std::uint32_t slots) {
    // Whether splats have creases is known only after collection, so records with faces always have room for them.
    DrawVariant roomy = variant;
    roomy.creases = cuts_at_faces(variant);
    const std::uint32_t rows = (slots * prepared_stride(roomy) + shader::PREPARED_ROW - 1) / shader::PREPARED_ROW;
    return {shader::PREPARED_ROW, rows};
}

std::uint32_t prepared_slots(std::uint64_t entries) {
    // A chunk rarely has more than a fourth of the entries; 4096 records take less than half a megabyte.
    const std::uint64_t wanted = std::max<std::uint64_t>(entries / 4, std::min<std::uint64_t>(entries, 4096));
    return static_cast<std::uint32_t>(std::bit_ceil(std::clamp<std::uint64_t>(wanted, 1, shader::PREPARED_ENTRIES)));
}

gpu::Pass prepare_splats(const DrawVariant& variant, std::uint32_t chunk, std::uint32_t count) {
    return {"4_prepare_splats", {{"4g_prepare_splats.comp", draw_constants(variant), gpu::Invocations{count}, chunk}}};
}

}  // namespace edgesplat::passes
