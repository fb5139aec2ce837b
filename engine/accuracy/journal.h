// What a long measurement has finished, on disk, so that it can be stopped at any time and go on later.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace edgesplat::accuracy {

/// A file of lines {"key", "value", "check"}, one per finished piece of work, synced to disk line by line. A line that
/// is cut off or does not fit its check is dropped, and its work is done again.
class Journal {
  public:
    /// Opens or begins it. `identity` says what is measured: a journal that was begun with another one is refused,
    /// unless `restart` throws it away. Throws Error, also where another process writes the same journal.
    Journal(std::filesystem::path path, const nlohmann::ordered_json& identity, bool restart = false);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// The value of a key; null where that is still to be done.
    const nlohmann::ordered_json* find(const std::string& key) const;

    /// Appends a finished piece of work; on disk when this returns. Throws Error.
    void add(const std::string& key, const nlohmann::ordered_json& value);

    std::size_t size() const { return values_.size(); }  ///< finished pieces
    int dropped() const { return dropped_; }             ///< damaged lines that were found when it was opened

  private:
    void read(const nlohmann::ordered_json& identity, bool restart);

    std::filesystem::path path_;
    std::map<std::string, nlohmann::ordered_json> values_;
    int file_ = -1;
    int dropped_ = 0;
};

/// 64-bit FNV-1a as 16 hexadecimal digits.
std::string checksum_of(std::string_view bytes);

}  // namespace edgesplat::accuracy
