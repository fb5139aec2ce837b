#include "engine/viewer/script.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/scene/nearest_name.h"
#include "engine/scene/text_file.h"

namespace edgesplat::viewer {
namespace {

constexpr std::array<ScriptVerb, 28> kVerbs{{
    {"size", "nn", "width and height of the window's content, pixels"},
    {"step", "n", "seconds from frame to frame from here on (1/60)"},
    {"quality", "w", "of pictures in motion: measured (by the clock), or fixed (level and size that do not change)"},
    {"open", "t", "a volume, folder, builtin:NAME or scene file; waits until it is there"},
    {"frames", "n", "lets so many frames pass"},
    {"settle", "", "lets frames pass until no better picture comes"},
    {"move", "nn", "the mouse goes to a pixel, from the window's top left corner"},
    {"drag", "nnn", "the mouse goes to a pixel in so many frames"},
    {"aim", "wnn", "the mouse goes to a widget, to shares of its width and height: aim scene.histogram 0.5 0.2"},
    {"tap", "w", "left button, down and up in the middle of a widget"},
    {"press", "b", "a mouse button goes down: left, right, middle"},
    {"release", "b", "it comes up"},
    {"click", "nn", "left button, down and up at a pixel"},
    {"double", "nn", "twice"},
    {"wheel", "n", "steps, > 0 away from the person"},
    {"hold", "k", "a key goes down"},
    {"let", "k", "it comes up"},
    {"key", "k", "a key is struck; Ctrl+Z and the like too"},
    {"sticks", "nnnnn", "a gamepad from here on: left stick right and up, right stick right and up, triggers' up"},
    {"type", "t", "text into the field that has the cursor"},
    {"drop", "t", "a file dropped on the window"},
    {"wander", "nn", "flies about for so many seconds, headings from a seed, pushed against whatever is in the way"},
    {"screenshot", "t", "writes the window's content to a PNG file"},
    {"picture", "t", "writes the picture as it is shown to a PNG file"},
    {"save", "t", "writes the scene to a file"},
    {"expect", "wct", "stops with an error unless a value (below) compares so: ==, !=, <, <=, >, >=, has"},
    {"lose", "w", "what happens when a device is lost: window or pictures"},
    {"report", "t", "writes what pictures took since the last report to a JSON file"},
}};

std::optional<double> number_in(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

bool is_comparison(std::string_view word) {
    constexpr std::array<std::string_view, 7> kAll{"==", "!=", "<", "<=", ">", ">=", "has"};
    return std::ranges::find(kAll, word) != kAll.end();
}

/// The next word of `rest`, taken off it.
std::string_view take_word(std::string_view& rest) {
    const auto begin = std::min(rest.find_first_not_of(" \t\r"), rest.size());
    rest.remove_prefix(begin);
    const auto end = std::min(rest.find_first_of(" \t\r"), rest.size());
    const std::string_view word = rest.substr(0, end);
    rest.remove_prefix(end);
    return word;
}

std::string_view trimmed(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

void check_word(const ScriptCommand& command, char kind, const std::string& word,
                const std::function<bool(std::string_view)>& is_key) {
    const auto refuse = [&](const char* expected) {
        fail("{}: {}: '{}', expected {}", command.where, command.verb, word, expected);
    };
    // Pixels, frames and seconds: all are counted in 32 bits somewhere.
    constexpr double kMost = 1e9;
    if (kind == 'n' && !number_in(word)) refuse("a number");
    if (kind == 'n' && std::abs(*number_in(word)) > kMost) refuse("a number from -1e9 to 1e9");
    if (kind == 'c' && !is_comparison(word)) refuse("==, !=, <, <=, >, >= or has");
    if (kind == 'b' && word != "left" && word != "right" && word != "middle") refuse("left, right or middle");
    if (kind != 'k') return;
    std::string_view key = word;
    if (key.starts_with("Ctrl+")) key.remove_prefix(5);
    if (!is_key(key)) refuse("a key: A to Z, 0 to 9, F1 to F12, Space, Enter, Escape, Home, Left, ...");
}

}  // namespace

std::span<const ScriptVerb> script_verbs() {
    return kVerbs;
}

double ScriptCommand::number(std::size_t word) const {
    return number_in(words.at(word)).value();
}

std::vector<ScriptCommand> parse_script(std::string_view text, const std::string& name,
                                        const std::function<bool(std::string_view)>& is_key) {
    std::vector<ScriptCommand> commands;
    for (int line = 1; !text.empty(); ++line) {
        const auto end = std::min(text.find('\n'), text.size());
        std::string_view rest = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (rest.empty() || rest.front() == '#') continue;
        ScriptCommand command{fmt::format("{}:{}", name, line), std::string(take_word(rest)), {}};
        const auto verb = std::ranges::find(kVerbs, command.verb, &ScriptVerb::name);
        if (verb == kVerbs.end()) {
            std::vector<std::string> names;
            for (const ScriptVerb& known : kVerbs)
                names.emplace_back(known.name);
            const std::string nearest = nearest_name(command.verb, names);
            fail("{}: '{}' is no command{}", command.where, command.verb,
                 nearest.empty() ? std::string() : fmt::format("; did you mean {}?", nearest));
        }
        // cppcheck-suppress derefInvalidIteratorRedundantCheck; fail() does not return
        for (const char kind : verb->words) {
            const std::string word(kind == 't' ? trimmed(std::exchange(rest, {})) : take_word(rest));
            if (word.empty()) fail("{}: {}: expected {} words", command.where, command.verb, verb->words.size());
            check_word(command, kind, word, is_key);
            command.words.push_back(word);
        }
        if (!trimmed(rest).empty() && trimmed(rest).front() != '#')
            fail("{}: {}: '{}' is too much, expected {} words", command.where, command.verb, trimmed(rest),
                 verb->words.size());
        commands.push_back(std::move(command));
    }
    return commands;
}

std::vector<ScriptCommand> read_script(const std::filesystem::path& path,
                                       const std::function<bool(std::string_view)>& is_key) {
    return parse_script(read_text_file(path, "a script"), path.string(), is_key);
}

bool holds(std::string_view left, std::string_view comparison, std::string_view right) {
    const auto a = number_in(left), b = number_in(right);
    if (comparison == "has") return left.find(right) != std::string_view::npos;
    if (comparison == "==") return a && b ? *a == *b : left == right;
    if (comparison == "!=") return a && b ? *a != *b : left != right;
    if (!a || !b) return false;
    if (comparison == "<") return *a < *b;
    if (comparison == "<=") return *a <= *b;
    if (comparison == ">") return *a > *b;
    return *a >= *b;
}

}  // namespace edgesplat::viewer
