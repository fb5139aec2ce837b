#include "engine/accuracy/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include "engine/accuracy/json_text.h"
#include "engine/error.h"
#include "engine/fnv1a.h"
#include "engine/image/image_file.h"
#include "footprints/temporary_file.h"

namespace edgesplat::accuracy {
namespace {

using nlohmann::ordered_json;

constexpr const char* kIdentityKey = "identity";

std::string check_of(const std::string& key, const ordered_json& value) {
    return checksum_of(key + "\n" + json_text(value));
}

void write_synced(int file, std::string_view text, const std::filesystem::path& path) {
    try {
        write_all(file, text);
    } catch (const std::system_error& error) {
        fail("cannot write {}: {}", path.string(), error.code().message());
    }
    if (fdatasync(file) != 0) fail("cannot write {}: {}", path.string(), std::strerror(errno));
}

std::string line_of(const std::string& key, const ordered_json& value) {
    return json_text(ordered_json{{"key", key}, {"value", value}, {"check", check_of(key, value)}}) + "\n";
}

/// Text of the keys in which two identities differ: "size: 192x192 there, 96x96 asked for; ...".
std::string differences(const ordered_json& there, const ordered_json& wanted) {
    std::string text;
    for (const auto& [key, value] : wanted.items()) {
        const ordered_json other = there.contains(key) ? there.at(key) : ordered_json();
        if (other == value) continue;
        const std::string a = json_text(other), b = json_text(value);
        const bool brief = a.size() + b.size() < 120;
        text += (text.empty() ? "" : "; ") + key + (brief ? fmt::format(": {} there, {} asked for", a, b) : " differs");
    }
    return text;
}

}  // namespace

std::string checksum_of(std::string_view bytes) {
    return fmt::format("{:016x}", fnv1a(bytes));
}

Journal::Journal(std::filesystem::path path, const ordered_json& identity, bool restart) : path_(std::move(path)) {
    file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) fail("cannot open {}: {}", path_.string(), std::strerror(errno));
    try {
        if (flock(file_, LOCK_EX | LOCK_NB) != 0) fail("{}: another process writes this report", path_.string());
        read(identity, restart);
    } catch (...) {
        close(file_);
        throw;
    }
}

Journal::~Journal() {
    close(file_);
}

void Journal::read(const ordered_json& identity, bool restart) {
    std::ifstream in(path_, std::ios::binary);
    std::string text;
    if (!restart) text.assign(std::istreambuf_iterator<char>(in), {});
    std::string good;
    bool known = false;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        const ordered_json entry = ordered_json::parse(line, nullptr, false);
        const bool whole = end < text.size() && entry.is_object() && entry.contains("key") &&
                           entry["key"].is_string() && entry.contains("value") && entry.contains("check") &&
                           entry["check"] == check_of(entry["key"], entry["value"]);
        begin = end + 1;
        if (!whole) {
            ++dropped_;
            continue;
        }
        good += line + "\n";
        if (entry["key"] != kIdentityKey) {
            values_[entry["key"]] = entry["value"];
            continue;
        }
        known = true;
        if (entry["value"] != identity)
            fail("{} belongs to another measurement ({}); use another folder, or delete it with --restart",
                 path_.string(), differences(entry["value"], identity));
    }
    if (!known) {  // without the identity the other lines are unusable
        values_.clear();
        good = line_of(kIdentityKey, identity);
    }
    // The file is changed in place, since the lock belongs to it. No good line is ever rewritten, since a full disk or
    // a kill would lose it. A line that is cut off at the end is removed; damaged lines before it stay and are skipped.
    const bool prefix = known && text.starts_with(good);
    if (!known || prefix)
        if (ftruncate(file_, known ? static_cast<off_t>(good.size()) : 0) != 0)
            fail("cannot write {}: {}", path_.string(), std::strerror(errno));
    lseek(file_, 0, SEEK_END);
    if (!known)
        write_synced(file_, good, path_);
    else if (!prefix && !text.ends_with('\n'))
        write_synced(file_, "\n", path_);
}

const ordered_json* Journal::find(const std::string& key) const {
    const auto found = values_.find(key);
    return found == values_.end() ? nullptr : &found->second;
}

void Journal::add(const std::string& key, const ordered_json& value) {
    const std::string line = line_of(key, value);
    write_synced(file_, line, path_);
    // The value as it will be read from the file, so that a second run computes the same to the last digit.
    values_[key] = ordered_json::parse(json_text(value));
}

}  // namespace edgesplat::accuracy
