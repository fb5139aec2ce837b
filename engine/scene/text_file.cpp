#include "engine/scene/text_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "engine/error.h"

namespace edgesplat {

namespace fs = std::filesystem;

std::string read_text_file(const fs::path& path, std::string_view expected) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) fail("{}: no such file", path.string());
    if (error) fail("{}: {}", path.string(), error.message());
    if (fs::is_directory(status)) fail("{}: is a folder; expected {}", path.string(), expected);
    // Opening a FIFO or a device would block.
    if (!fs::is_regular_file(status)) fail("{}: is not a regular file; expected {}", path.string(), expected);
    const std::uintmax_t size = fs::file_size(path, error);
    if (!error && size > kMaxTextBytes)
        fail("{}: {} bytes; expected {} of at most {}", path.string(), size, expected, kMaxTextBytes);
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    std::string text(error ? 0 : static_cast<std::size_t>(size), '\0');
    if (!in || !in.read(text.data(), static_cast<std::streamsize>(text.size())))
        fail("{}: cannot be read: {}", path.string(), errno == 0 ? "it ends too early" : std::strerror(errno));
    return text;
}

std::size_t invalid_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const std::size_t length = lead < 0x80                   ? 1
                                   : lead >= 0xC2 && lead < 0xE0 ? 2
                                   : lead >= 0xE0 && lead < 0xF0 ? 3
                                   : lead >= 0xF0 && lead < 0xF5 ? 4
                                                                 : 0;
        if (length == 0 || i + length > text.size()) return i;
        for (std::size_t k = 1; k < length; ++k)
            if ((static_cast<unsigned char>(text[i + k]) & 0xC0) != 0x80) return i;
        i += length;
    }
    return std::string_view::npos;
}

std::string valid_utf8(std::string_view text) {
    std::string out;
    for (;;) {
        const std::size_t bad = invalid_utf8(text);
        out += text.substr(0, bad);
        if (bad == std::string_view::npos) return out;
        out += "\xEF\xBF\xBD";
        text.remove_prefix(bad + 1);
    }
}

}  // namespace edgesplat
