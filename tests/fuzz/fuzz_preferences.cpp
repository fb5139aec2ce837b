// The viewer's preferences: every file gives preferences within their ranges, and these round-trip.
#include <cstdlib>

#include "engine/viewer/preferences.h"
#include "tests/fuzz/fuzz_file.h"

using namespace edgesplat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const viewer::Preferences read = viewer::read_preferences(fuzz::write("fly.toml", fuzz::text_of(data, size)));
    if (read.width < 320 || read.height < 240 || read.recent.size() > viewer::kMostRecent) std::abort();
    const std::filesystem::path again = fuzz::folder() / "again.toml";
    viewer::write_preferences(read, again);
    if (!(viewer::read_preferences(again) == read)) std::abort();
    return 0;
}
