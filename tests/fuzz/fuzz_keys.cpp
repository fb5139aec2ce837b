// Single keys of a scene as in `--set KEY=VALUE`, one per line.
#include <algorithm>
#include <cstdlib>

#include "engine/error.h"
#include "engine/scene/scene_file.h"
#include "tests/fuzz/fuzz_file.h"

using namespace edgesplat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    (void)fuzz::folder();
    SceneDocument document;
    document.volume.path = "builtin:sphere:8";
    std::string_view rest = fuzz::text_of(data, size);
    for (int line = 0; line < 32 && !rest.empty(); ++line) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        try {
            set_key(document, rest.substr(0, end));
        } catch (const Error&) {
        }
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (!(parse_scene(scene_text(document), "again.toml", {.folders = {}, .whole = false}) == document)) std::abort();
    return 0;
}
