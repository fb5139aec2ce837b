#include "engine/scene/scene_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/error.h"
#include "engine/scene/nearest_name.h"
#include "engine/scene/text_file.h"

namespace edgesplat {
namespace {

std::string range_text(const KeyRange& range) {
    const bool low = std::isfinite(range.low), high = std::isfinite(range.high);
    const char* from = range.above_low ? "above" : "from";
    const char* to = range.below_high ? "below" : "to";
    if (low && high) return fmt::format(" {} {} {} {}", from, range.low, to, range.high);
    if (low) return fmt::format(" {} {}", range.above_low ? "above" : "of at least", range.low);
    return "";
}

bool in_range(double value, const KeyRange& range) {
    const bool above = range.above_low ? value > range.low : value >= range.low;
    const bool below = range.below_high ? value < range.high : value <= range.high;
    return above && below && std::isfinite(value);
}

bool whole(double value) {
    return std::trunc(value) == value;
}

/// The last component of a path.
std::string leaf(std::string_view path) {
    return std::string(path.substr(path.rfind('.') + 1));
}

std::string with_index(const std::string& path, std::size_t index) {
    const std::size_t at = path.find("[]");
    if (at == std::string::npos) return path;
    return fmt::format("{}[{}]{}", path.substr(0, at), index, path.substr(at + 2));
}

double& number_in(KeyValue& value, const KeyAddress& address, std::string_view text) {
    if (double* number = std::get_if<double>(&value); number && !address.component) return *number;
    auto* list = std::get_if<std::vector<double>>(&value);
    if (!list || !address.component) fail("{}: is not a single number", text);
    if (*address.component >= list->size()) fail("{}: the list has {} numbers", text, list->size());
    return (*list)[*address.component];
}

/// The key and its current value, or Error.
std::pair<const SceneKey*, KeyValue> value_at(const SceneDocument& document, const KeyAddress& address,
                                              std::string_view text) {
    const SceneKey* key = find_key(address.path);
    if (!key) {
        const std::string unknown = unknown_key(text);
        fail("{}: {}", text, unknown);
    }
    const std::string table = table_of(*key);
    const SceneTable* group = find_table(table.ends_with("[]") ? table.substr(0, table.size() - 2) : table);
    if (group && group->count(document) <= address.index)
        fail("{}: the scene has no {}", text, with_index(table, address.index));
    const std::optional<KeyValue> value = key->get(document, address.index);
    if (!value) fail("{}: the scene does not set it", text);
    return {key, *value};
}

}  // namespace

std::string SceneKey::path_at(std::size_t index) const {
    return with_index(path, index);
}

std::string SceneKey::expectation() const {
    const auto with_unit = [this](const std::string& text) { return unit.empty() ? text : text + " (" + unit + ")"; };
    const std::string one_of = fmt::format("{}", fmt::join(choices, ", "));
    switch (type) {
        case KeyType::Flag:
            return "true or false";
        case KeyType::Number:
            return with_unit("a number" + range_text(range));
        case KeyType::Integer:
            return with_unit("a whole number" + range_text(range));
        case KeyType::Text:
            return choices.empty() ? "a text" : "one of: " + one_of;
        case KeyType::Texts:
            return choices.empty() ? "a list of texts" : "a list of: " + one_of;
        default:
            break;
    }
    if (points) return with_unit("a list of at least two points, such as [[0, 0, 0], [1, 2, 3]]");
    const char* kind = type == KeyType::Integers ? "whole numbers" : "numbers";
    const std::string many =
        count > 0 ? fmt::format("a list of {} {}", count, kind) : fmt::format("a list of {}", kind);
    return with_unit(many + (direction ? ", not all 0" : range_text(range)));
}

std::string SceneKey::refusal(const KeyValue& value) const {
    const auto refuse = [&] { return fmt::format("{}: expected {}", toml_text(value, type), expectation()); };
    const auto fits = [this](double number) {
        return in_range(number, range) && (type == KeyType::Number || type == KeyType::Numbers || whole(number));
    };
    if (const auto* number = std::get_if<double>(&value)) return fits(*number) ? "" : refuse();
    const auto chosen = [this](const std::string& text) {
        return choices.empty() || std::find(choices.begin(), choices.end(), text) != choices.end();
    };
    const auto suggestion = [this](const std::string& text) -> std::string {
        const std::string name = nearest_name(text, choices);
        return name.empty() ? "" : "; did you mean \"" + name + "\"?";
    };
    if (const auto* text = std::get_if<std::string>(&value)) return chosen(*text) ? "" : refuse() + suggestion(*text);
    if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
        for (const std::string& text : *texts)
            if (!chosen(text)) return refuse() + suggestion(text);
    }
    if (const auto* list = std::get_if<std::vector<double>>(&value)) {
        if (count > 0 && list->size() != count) return refuse();
        if (points && (list->size() % 3 != 0 || list->size() < 6)) return refuse();
        if (!std::all_of(list->begin(), list->end(), fits)) return refuse();
        if (direction && std::all_of(list->begin(), list->end(), [](double v) { return v == 0; })) return refuse();
    }
    return "";
}

std::string table_of(const SceneKey& key) {
    const std::size_t end = key.path.rfind('.');
    return end == std::string::npos ? "" : key.path.substr(0, end);
}

const SceneKey* find_key(std::string_view path) {
    const auto keys = scene_keys();
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const SceneKey& key) { return key.path == path; });
    return found == keys.end() ? nullptr : &*found;
}

const SceneTable* find_table(std::string_view path) {
    const auto tables = scene_tables();
    const auto found =
        std::find_if(tables.begin(), tables.end(), [&](const SceneTable& table) { return table.path == path; });
    return found == tables.end() ? nullptr : &*found;
}

bool is_of_added(std::string_view path) {
    return std::ranges::count(kAddedKeys, path.substr(0, path.find_first_of(".["))) > 0;
}

std::optional<std::pair<std::size_t, std::string_view>> added_address(std::string_view path) {
    constexpr std::string_view kList = "volumes[";
    if (!path.starts_with(kList)) return std::nullopt;
    std::size_t number = 0;
    const auto [next, error] = std::from_chars(path.data() + kList.size(), path.data() + path.size(), number);
    const std::string_view rest = path.substr(static_cast<std::size_t>(next - path.data()));
    if (error != std::errc() || !rest.starts_with("].") || !is_of_added(rest.substr(2)))
        fail("{}: expected volumes[NUMBER].KEY, with a key of one of: {}", path, fmt::join(kAddedKeys, ", "));
    return std::pair(number, rest.substr(2));
}

namespace {

/// The document of an entry of `volumes`. Throws Error if there is none.
template <typename Document>
Document& added_entry(Document& document, std::size_t number) {
    if (number >= document.volumes.size())
        fail("volumes[{}]: the scene has {} volumes beside the first", number, document.volumes.size());
    return document.volumes[number];
}

}  // namespace

KeyAddress key_address(std::string_view concrete) {
    KeyAddress address;
    std::string_view rest = concrete;
    while (!rest.empty()) {
        const std::size_t open = rest.find('[');
        address.path += rest.substr(0, open);
        if (open == std::string_view::npos) break;
        const std::size_t close = rest.find(']', open);
        std::size_t number = 0;
        const char* begin = rest.data() + open + 1;
        const char* end = rest.data() + std::min(close, rest.size());
        const auto [next, error] = std::from_chars(begin, end, number);
        if (close == std::string_view::npos || error != std::errc() || next != end)
            fail("{}: is not a key of a scene; an index is a whole number, e.g. lights[0].color", concrete);
        rest = rest.substr(close + 1);
        if (rest.empty() && !find_table(address.path)) {
            address.component = number;
        } else {
            address.index = number;
            address.path += "[]";
        }
    }
    return address;
}

std::string unknown_key(std::string_view concrete) {
    const std::string nearest = nearest_key(concrete);
    return nearest.empty() ? "unknown key" : "unknown key; did you mean " + nearest + "?";
}

std::string nearest_key(std::string_view concrete) {
    std::string generic;
    std::vector<std::string> indices;
    for (std::size_t i = 0; i < concrete.size(); ++i) {
        generic += concrete[i];
        if (concrete[i] != '[') continue;
        const std::size_t close = std::min(concrete.find(']', i), concrete.size());
        indices.emplace_back(concrete.substr(i + 1, close - i - 1));
        i = close - 1;
    }
    std::vector<std::string> paths, siblings;
    for (const SceneKey& key : scene_keys())
        paths.push_back(key.path);
    for (const SceneKey& key : scene_keys())  // also their tables and parent tables
        for (std::size_t end = key.path.find('.'); end != std::string::npos; end = key.path.find('.', end + 1)) {
            std::string table = key.path.substr(0, end);
            if (table.ends_with("[]")) table.resize(table.size() - 2);
            if (std::find(paths.begin(), paths.end(), table) == paths.end()) paths.push_back(table);
        }
    const auto parent_of = [](const std::string& path) {
        const std::size_t end = path.rfind('.');
        return end == std::string::npos ? std::string() : path.substr(0, end + 1);
    };
    for (const std::string& path : paths)
        if (parent_of(path) == parent_of(generic)) siblings.push_back(path.substr(parent_of(path).size()));
    std::string best = nearest_name(leaf(generic), siblings);
    if (!best.empty()) best = parent_of(generic) + best;
    // The correct name in the wrong table.
    for (std::size_t i = 0; best.empty() && i < paths.size(); ++i)
        if (leaf(paths[i]) == leaf(generic)) best = paths[i];
    if (best.empty()) best = nearest_name(generic, paths);
    for (const std::string& index : indices) {
        const std::size_t at = best.find("[]");
        if (at == std::string::npos) break;
        best.insert(at + 1, index);
    }
    return best;
}

std::string toml_text(const KeyValue& value, KeyType type) {
    const auto number = [type](double v) {
        if (type == KeyType::Integer || type == KeyType::Integers) return fmt::format("{:.17g}", v);
        const std::string text = fmt::format("{}", v);
        return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
    };
    const auto quoted = [](const std::string& text) {
        std::string out = "\"";
        for (const char c : valid_utf8(text)) {
            const auto byte = static_cast<unsigned char>(c);
            if (c == '"' || c == '\\')
                (out += '\\') += c;
            else if (byte < 0x20 || byte == 0x7f)
                out += fmt::format("\\u{:04x}", byte);
            else
                out += c;
        }
        return out + "\"";
    };
    const auto list = [](const auto& items, const auto& spelled) {
        std::string out = "[";
        for (std::size_t i = 0; i < items.size(); ++i)
            (out += i > 0 ? ", " : "") += spelled(items[i]);
        return out + "]";
    };
    if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
    if (const auto* one = std::get_if<double>(&value)) return number(*one);
    if (const auto* text = std::get_if<std::string>(&value)) return quoted(*text);
    if (const auto* numbers = std::get_if<std::vector<double>>(&value)) return list(*numbers, number);
    return list(std::get<std::vector<std::string>>(value), quoted);
}

double number_at(const SceneDocument& document, std::string_view key) {
    if (const auto added = added_address(key)) return number_at(added_entry(document, added->first), added->second);
    const KeyAddress address = key_address(key);
    KeyValue value = value_at(document, address, key).second;
    return number_in(value, address, key);
}

void set_number(SceneDocument& document, std::string_view key, double number) {
    if (const auto added = added_address(key))
        return set_number(added_entry(document, added->first), added->second, number);
    const KeyAddress address = key_address(key);
    auto [entry, value] = value_at(document, address, key);
    number_in(value, address, key) = number;
    const std::string refusal = entry->refusal(value);
    if (!refusal.empty()) fail("{}: {}", key, refusal);
    entry->set(document, address.index, value);
}

}  // namespace edgesplat
