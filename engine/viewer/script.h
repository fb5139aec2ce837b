// Scripts of user input: one command per line, replayed with a fixed time step.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::viewer {

/// A verb of the script language.
struct ScriptVerb {
    std::string_view name;
    /// The words that follow, one letter per word: n number, k key, b mouse button, t rest of the line, w word, c
    /// comparison.
    std::string_view words;
    std::string_view help;
};
std::span<const ScriptVerb> script_verbs();

/// One command of a script.
struct ScriptCommand {
    std::string where;  ///< "file:line", for messages
    std::string verb;
    std::vector<std::string> words;
    double number(std::size_t word) const;  ///< the word must be a number
};

/// Parses a script: one command per line, `#` begins a comment, empty lines are skipped. `is_key` tells whether a key
/// name is known. Throws Error with file and line: an unknown verb (with the nearest known one), or words that are
/// missing, superfluous or of the wrong kind.
std::vector<ScriptCommand> parse_script(std::string_view text, const std::string& name,
                                        const std::function<bool(std::string_view)>& is_key);
std::vector<ScriptCommand> read_script(const std::filesystem::path& path,
                                       const std::function<bool(std::string_view)>& is_key);

/// Compares as `expect` does. ==, !=, <, <=, >, >= compare numbers. == and != also compare texts; `has` tests for a
/// part of a text.
bool holds(std::string_view left, std::string_view comparison, std::string_view right);

}  // namespace edgesplat::viewer
