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
    {"size", "nn", "sets width and height of the window's content, pixels"},
    {"step", "n", "sets the time step of the frames that follow, seconds (1/60)"},
    {"quality", "w", "sets the resolution in motion: measured (adapted to the times of pictures), or fixed (constant)"},
    {"open", "t", "opens a volume, folder, builtin:NAME or scene file, and waits until it is loaded"},
    {"frames", "n", "runs a number of frames"},
    {"settle", "", "runs frames until no better picture follows"},
    {"move", "nn", "moves the mouse to a pixel, counted from the window's top left corner"},
    {"drag", "nnn", "moves the mouse to a pixel in a number of frames"},
    {"aim", "wnn", "moves the mouse to shares of a widget's width and height: aim scene.histogram 0.5 0.2"},
    {"tap", "w", "clicks the left button in the middle of a widget"},
    {"press", "b", "presses a mouse button: left, right, middle"},
    {"release", "b", "releases a mouse button"},
    {"click", "nn", "clicks the left button at a pixel"},
    {"double", "nn", "double-clicks the left button at a pixel"},
    {"wheel", "n", "turns the wheel by a number of steps, > 0 away from the user"},
    {"hold", "k", "presses a key"},
    {"let", "k", "releases a key"},
    {"key", "k", "presses and releases a key, or a combination such as Ctrl+Z"},
    {"sticks", "nnnnn", "sets a gamepad's axes: left stick right and up, right stick right and up, triggers up"},
    {"type", "t", "types text into the active field"},
    {"drop", "t", "drops a file on the window"},
    {"wander", "nn", "flies for a number of seconds in random directions, also against walls; second number: seed"},
    {"screenshot", "t", "writes the window's content to a PNG file"},
    {"picture", "t", "writes the displayed picture to a PNG file"},
    {"save", "t", "writes the scene to a file"},
    {"expect", "wct", "stops with an error unless a comparison of a value (below) is true: ==, !=, <, <=, >, >=, has"},
    {"lose", "w", "simulates the loss of a device: that of the window, or that of the pictures"},
    {"report", "t", "writes the times of all pictures since the last report to a JSON file"},
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

/// Removes the next word from `rest` and returns it.
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
    // Pixels, frames and seconds are all counted in 32 bits somewhere.
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
            fail("{}: '{}' is not a command{}", command.where, command.verb,
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
            fail("{}: {}: unexpected word '{}', expected {} words", command.where, command.verb, trimmed(rest),
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
