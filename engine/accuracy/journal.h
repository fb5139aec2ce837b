// Keeps the finished parts of a long measurement on disk, so that it can be stopped and continued at any time.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace edgesplat::accuracy {

/// A file of lines {"key", "value", "check"}, one per finished piece of work, each synced to disk. A line that is cut
/// off or does not match its check is discarded, and its work is done again.
class Journal {
  public:
    /// Opens or creates the journal. `identity` describes what is measured; a journal with another identity is refused,
    /// or deleted with `restart`. Throws Error, also if another process writes the same journal.
    Journal(std::filesystem::path path, const nlohmann::ordered_json& identity, bool restart = false);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// The value of a key; nullptr if that work is not done yet.
    const nlohmann::ordered_json* find(const std::string& key) const;

    /// Appends a finished piece of work; it is on disk when this returns. Throws Error.
    void add(const std::string& key, const nlohmann::ordered_json& value);

    std::size_t size() const { return values_.size(); }  ///< finished pieces
    int dropped() const { return dropped_; }             ///< damaged lines found when the journal was opened

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
