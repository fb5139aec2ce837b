// Writes a SceneDocument as TOML, and the key table as text.
#include <fmt/format.h>

#include <algorithm>

#include "engine/error.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/scene_keys.h"
#include "engine/scene/text_file.h"

namespace edgesplat {
namespace {

std::string leaf_of(const std::string& path) {
    return path.substr(path.rfind('.') == std::string::npos ? 0 : path.rfind('.') + 1);
}

/// A value as in a file.
std::string spelled(const SceneKey& key, const KeyValue& value) {
    if (!key.points) return toml_text(value, key.type);
    const auto& numbers = std::get<std::vector<double>>(value);
    std::string out = "[";
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
        out +=
            (i > 0 ? ", " : "") + toml_text(std::vector<double>{numbers[i], numbers[i + 1], numbers[i + 2]}, key.type);
    return out + "]";
}

/// The default as text.
std::string default_text(const SceneKey& key) {
    return key.default_value ? spelled(key, *key.default_value) : key.absent;
}

/// Groups adjacent keys of the same table.
std::vector<std::span<const SceneKey>> sections() {
    std::vector<std::span<const SceneKey>> all;
    const auto keys = scene_keys();
    for (std::size_t begin = 0; begin < keys.size();) {
        std::size_t end = begin;
        while (end < keys.size() && table_of(keys[end]) == table_of(keys[begin]))
            ++end;
        all.push_back(keys.subspan(begin, end - begin));
        begin = end;
    }
    return all;
}

/// The optional or list table of a section, or null.
const SceneTable* group_of(const std::string& table) {
    return find_table(table.ends_with("[]") ? table.substr(0, table.size() - 2) : table);
}

std::string header_of(const std::string& table, const std::string& before = "") {
    if (table.ends_with("[]")) return "[[" + before + table.substr(0, table.size() - 2) + "]]";
    return "[" + before + table + "]";
}

/// Writes lists that are empty although their default is not: table headers cannot express this.
std::string empty_lists(const SceneDocument& document) {
    const SceneDocument defaults;
    std::string out;
    for (const SceneTable& table : scene_tables())
        if (table.list && table.count(document) == 0 && table.count(defaults) > 0) out += table.path + " = []\n";
    return out;
}

std::string wrapped_comment(const std::string& text) {
    constexpr std::size_t kWidth = 110;
    std::string out, line = "#";
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        if (line.size() + 1 + word.size() > kWidth) {
            out += line + "\n";
            line = "#";
        }
        line += " " + word;
        begin = end + 1;
    }
    return out + line + "\n";
}

std::string comment_of(const SceneKey& key) {
    const bool any_text = key.type == KeyType::Text && key.choices.empty();
    const std::string what = any_text ? key.help : key.help + ": " + key.expectation();
    return wrapped_comment(fmt::format("{}. Default: {}", what, default_text(key)));
}

/// Example value of a key that is commented out: its default, else a value of the correct type.
std::string example_of(const SceneKey& key) {
    if (key.default_value) return spelled(key, *key.default_value);
    if (key.absent.find_first_not_of("0123456789.,[] ") == std::string::npos) return key.absent;
    switch (key.type) {
        case KeyType::Flag:
            return "false";
        case KeyType::Text:
            return key.choices.empty() ? "\"\"" : "\"" + key.choices.front() + "\"";
        case KeyType::Texts:
            return key.choices.empty() ? "[]" : "[\"" + key.choices.front() + "\"]";
        case KeyType::Number:
        case KeyType::Integer:
            return "0";
        default:
            if (key.count == 16) return "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]";
            return key.points ? "[[0, 0, 0], [1, 1, 1]]" : key.count == 3 ? "[0, 0, 0]" : "[0]";
    }
}

}  // namespace

void check_path_is_text(const SceneDocument& document) {
    if (invalid_utf8(document.volume.path) != std::string::npos)
        fail("volume: {}: its name is not UTF-8, which scene files require", document.volume.path);
}

namespace {

/// The keys that are set, below the table `before` ("volumes." for an entry of that list).
std::string keys_text(const SceneDocument& document, const std::string& before) {
    std::string out;
    for (const auto& keys : sections()) {
        if (!before.empty() && !is_of_added(keys.front().path) && !table_of(keys.front()).empty()) continue;
        const std::string table = table_of(keys.front());
        const SceneTable* group = group_of(table);
        const std::size_t count = group ? group->count(document) : 1;
        for (std::size_t i = 0; i < count; ++i) {
            std::string body;
            for (const SceneKey& key : keys)
                if (const auto value = key.get(document, i); value && (before.empty() || is_of_added(key.path)))
                    body += fmt::format("{} = {}\n", leaf_of(key.path), spelled(key, *value));
            if (!table.empty() && (group || !body.empty())) out += "\n" + header_of(table, before) + "\n";
            out += body;
        }
        if (table.empty() && before.empty()) out += empty_lists(document);
    }
    return out;
}

std::string added_text(const SceneDocument& document) {
    std::string out;
    for (const SceneDocument& entry : document.volumes)
        out += "\n[[volumes]]\n" + keys_text(entry, "volumes.");
    return out;
}

}  // namespace

std::string scene_text(const SceneDocument& document) {
    return keys_text(document, "") + added_text(document);
}

std::string commented_scene_text(const SceneDocument& document) {
    std::string out =
        "# A scene of edgesplat. Keys behind # are not set; they have their default.\n"
        "# All keys: docs/scene_files.md, or `edgesplat scene keys`.\n\n";
    for (const auto& keys : sections()) {
        const std::string table = table_of(keys.front());
        const SceneTable* group = group_of(table);
        const std::size_t count = group ? group->count(document) : 1;
        for (std::size_t i = 0; i < std::max<std::size_t>(count, 1); ++i) {
            const bool there = count > 0;
            if (!table.empty()) {
                out += "\n" + (group && i == 0 ? wrapped_comment(group->help + ".") : std::string());
                out += (there ? "" : "# ") + header_of(table) + "\n";
            }
            for (const SceneKey& key : keys) {
                const auto value = there ? key.get(document, i) : std::nullopt;
                if (i > 0 && !value) continue;  // the list's first entry explains it
                if (i == 0) out += comment_of(key);
                out += value ? fmt::format("{} = {}\n", leaf_of(key.path), spelled(key, *value))
                             : fmt::format("# {} = {}\n", leaf_of(key.path), example_of(key));
            }
        }
        if (table.empty()) out += empty_lists(document);
    }
    out += "\n" + wrapped_comment(std::string(kAddedHelp) + ".");
    return out + (document.volumes.empty() ? "# [[volumes]]\n" : added_text(document));
}

std::string scene_keys_text() {
    std::string out;
    for (const auto& keys : sections()) {
        const std::string table = table_of(keys.front());
        const SceneTable* group = group_of(table);
        if (!table.empty()) out += "\n" + header_of(table) + (group ? "  " + group->help : "") + "\n";
        for (const SceneKey& key : keys)
            out += fmt::format("{}\n    {}\n    {}; default: {}\n", key.path, key.help, key.expectation(),
                               default_text(key));
    }
    return out + fmt::format("\n[[volumes]]  {}\n", kAddedHelp);
}

std::string scene_keys_markdown() {
    const auto cell = [](std::string text) {
        for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
            text.replace(at, 1, "\\|");
        return text;
    };
    std::string out;
    for (const auto& keys : sections()) {
        const std::string table = table_of(keys.front());
        const SceneTable* group = group_of(table);
        out += table.empty() ? "### At the top\n\n" : fmt::format("\n### `{}`\n\n", header_of(table));
        if (group) out += group->help + ".\n\n";
        out += "| key | what | value | default |\n|---|---|---|---|\n";
        for (const SceneKey& key : keys)
            out += fmt::format("| `{}` | {} | {} | {} |\n", leaf_of(key.path), cell(key.help), cell(key.expectation()),
                               cell(key.default_value ? "`" + default_text(key) + "`" : key.absent));
    }
    return out + fmt::format("\n### `[[volumes]]`\n\n{}.\n", kAddedHelp);
}

}  // namespace edgesplat
