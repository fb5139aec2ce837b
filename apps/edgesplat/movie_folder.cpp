#include "apps/edgesplat/movie_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <vector>

#include "engine/accuracy/json_text.h"
#include "engine/error.h"
#include "engine/fnv1a.h"
#include "engine/image/image_file.h"
#include "footprints/temporary_file.h"

namespace fs = std::filesystem;
using edgesplat::fail;
using nlohmann::ordered_json;

namespace {

constexpr const char* kNote = "movie.json";

/// Names of the entries in which two notes differ.
std::vector<std::string> differences(const ordered_json& a, const ordered_json& b) {
    std::vector<std::string> names;
    for (const auto* one : {&a, &b})
        for (const auto& [name, value] : one->items()) {
            const bool same = a.contains(name) && b.contains(name) && a[name] == b[name];
            if (!same && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        }
    return names;
}

}  // namespace

FramePattern::FramePattern(const std::string& name) {
    const std::size_t percent = name.find('%');
    std::size_t end = percent == std::string::npos ? name.size() : percent + 1;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0)
        ++end;
    const std::string digits = percent == std::string::npos ? "" : name.substr(percent + 1, end - percent - 1);
    const bool numbered = end < name.size() && name[end] == 'd' && name.find('%', end) == std::string::npos;
    if (!numbered || digits.size() > 2 || (!digits.empty() && digits[0] != '0'))
        fail("{}: not a pattern of frame names; expected one number in it, such as frame_%04d.png", name);
    before_ = name.substr(0, percent);
    after_ = name.substr(end + 1);
    digits_ = digits.empty() ? 1 : std::stoi(digits);
}

std::string FramePattern::name(int frame) const {
    return fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

bool FramePattern::matches(std::string_view name) const {
    if (name.size() <= before_.size() + after_.size() || !name.starts_with(before_) || !name.ends_with(after_))
        return false;
    const std::string_view number = name.substr(before_.size(), name.size() - before_.size() - after_.size());
    return number.size() >= static_cast<std::size_t>(digits_) &&
           std::all_of(number.begin(), number.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

MovieFolder::MovieFolder(const fs::path& folder, const FramePattern& pattern, const ordered_json& decided_by,
                         bool restart)
    : folder_(folder.empty() ? "." : folder), pattern_(pattern) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) fail("{}: cannot create this folder: {}", folder_.string(), error.message());
    lock();
    edgesplat::remove_stale_temporaries(folder_);
    bool frames = false;
    for (const auto& entry : fs::directory_iterator(folder_))
        frames |= pattern_.matches(entry.path().filename().string());
    if (restart) {
        remove_frames();
    } else if (frames || fs::exists(folder_ / kNote)) {
        std::ifstream file(folder_ / kNote);
        const ordered_json note = ordered_json::parse(file, nullptr, false);
        if (note.is_discarded() || !note.contains("decided_by"))
            fail("{}: contains frames of unknown origin; --restart deletes them and starts again", folder_.string());
        const auto changed = differences(note["decided_by"], ordered_json::parse(edgesplat::json_text(decided_by)));
        if (!changed.empty())
            fail(
                "{}: its frames were made with different values of: {}; use the same values, or --restart to delete "
                "the frames",
                folder_.string(), fmt::join(changed, ", "));
        return;
    }
    const ordered_json note{{"hash", fmt::format("{:016x}", edgesplat::fnv1a(edgesplat::json_text(decided_by)))},
                            {"decided_by", decided_by}};
    const edgesplat::FileContent content{folder_ / kNote, edgesplat::json_text(note, 2) + "\n"};
    edgesplat::write_files({&content, 1});
}

MovieFolder::~MovieFolder() {
    if (lock_ >= 0) ::close(lock_);
}

void MovieFolder::lock() {
    lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
        ::close(lock_);
        fail("{}: another process is writing these frames", folder_.string());
    }
}

void MovieFolder::remove_frames() const {
    std::error_code ignored;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder_))
        if (pattern_.matches(entry.path().filename().string())) files.push_back(entry.path());
    for (const fs::path& file : files)
        fs::remove(file, ignored);
    // The note is removed last, so that frames never exist without it.
    fs::remove(folder_ / kNote, ignored);
}

void MovieFolder::remove() {
    remove_frames();
    std::error_code ignored;
    fs::remove(folder_, ignored);
}
