// Pictures whose samples OpenImageIO would change: it replaces indices by colours and scales odd depths to whole bytes.
// Internal to engine/volume/io.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "engine/files/picture_library_internal.h"

namespace edgesplat::detail {

/// Opens a PNG, GIF, portable grey or colour map (P2, P3, P5, P6), or BMP with a palette, and decodes it. Null for
/// other files. Samples are as stored: palette images have one channel of indices, 4 bits are 0 to 15. Throws Error if
/// the file is damaged. Whether the first bytes of a file are those of such a picture.
bool begins_as_exact_picture(std::string_view head);
std::unique_ptr<PictureReader> open_exact_picture(const std::string& path);

}  // namespace edgesplat::detail
