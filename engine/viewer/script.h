// What a person does, written down: one command a line, replayed with a fixed time step.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::viewer {

/// A verb of scripts.
struct ScriptVerb {
    std::string_view name;
    /// One letter a word: n a number, k a key, b a button, t the rest of the line as text, w a word, c a comparison.
    std::string_view words;
    std::string_view help;
};
std::span<const ScriptVerb> script_verbs();

/// One command of a script.
struct ScriptCommand {
    std::string where;  ///< "file:line", for messages
    std::string verb;
    std::vector<std::string> words;
    double number(std::size_t word) const;  ///< of a word that is one
};

/// Reads a script: a command a line, `#` begins a comment, empty lines are skipped. `is_key` knows the keys' names.
/// Throws Error naming file and line: an unknown verb (with the nearest), words that are missing, too many or no
/// numbers.
std::vector<ScriptCommand> parse_script(std::string_view text, const std::string& name,
                                        const std::function<bool(std::string_view)>& is_key);
std::vector<ScriptCommand> read_script(const std::filesystem::path& path,
                                       const std::function<bool(std::string_view)>& is_key);

/// Compares as `expect` does: ==, !=, <, <=, >, >= of numbers; == and != of texts, `has` for a part of one.
bool holds(std::string_view left, std::string_view comparison, std::string_view right);

}  // namespace edgesplat::viewer
