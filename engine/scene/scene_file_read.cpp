// Reads TOML into a SceneDocument, key by key.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "engine/scene/scene_file.h"
#include "engine/scene/scene_keys.h"
#include "engine/scene/scene_table.h"
#include "engine/scene/text_file.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

/// The keys of a preset; of [volume] only `labels`.
constexpr std::array<std::string_view, 11> kPresetKeys{"about",      "iso_values", "iso_sigmas", "materials",
                                                       "transfer",   "ambient",    "lit",        "lights",
                                                       "background", "effects",    "volume"};
constexpr std::string_view kPresetVolumeKey = "volume.labels";

using Problem = SceneTableProblem;

/// A value to set in the document.
struct Assignment {
    const SceneKey* key;
    std::size_t index;
    std::string path;
    KeyValue value;
    std::size_t line;
};

/// Reads a TOML tree with the table of keys.
class Reader {
  public:
    /// `added`: the document is an entry of `volumes`.
    Reader(SceneDocument& document, bool preset, bool added = false)
        : document_(document), preset_(preset), added_(added) {
        for (const SceneKey& key : scene_keys())
            for (std::string path = table_of(key); !path.empty();
                 path.resize(path.rfind('.') == std::string::npos ? 0 : path.rfind('.')))
                groups_.insert(path);
    }

    void read_table(const toml::table& table, const std::string& concrete, const std::string& generic,
                    std::size_t index) {
        for (auto&& [key, node] : table) {
            const std::string inside = fmt::format("{}{}", generic.empty() ? "" : ".", key.str());
            read_node(node, concrete + inside, generic + inside, index, line_of(key));
        }
    }

    /// Sets all values in the order of the key table, so that a preset precedes individual knobs.
    void apply() {
        std::stable_sort(assignments_.begin(), assignments_.end(),
                         [](const Assignment& a, const Assignment& b) { return a.key < b.key; });
        for (const Assignment& assignment : assignments_)
            assignment.key->set(document_, assignment.index, assignment.value);
    }

    void add_problem(std::size_t line, const std::string& path, const std::string& text) {
        problems_.push_back({line, path.empty() ? text : path + ": " + text});
    }

    /// The line of a path, or of its closest parent in the file.
    std::size_t line_of_path(std::string path) const {
        while (!path.empty()) {
            const auto found = lines_.find(path);
            if (found != lines_.end()) return found->second;
            const std::size_t end = path.find_last_of(".[");
            path = end == std::string::npos ? "" : path.substr(0, end);
        }
        return 1;
    }

    std::vector<Problem>& problems() { return problems_; }

    void read_node(const toml::node& node, const std::string& concrete, const std::string& generic, std::size_t index,
                   std::size_t line) {
        lines_[concrete] = line;
        const std::string top = generic.substr(0, generic.find_first_of(".["));
        const bool for_presets = std::ranges::count(kPresetKeys, std::string_view(top)) > 0 &&
                                 (top != "volume" || generic == top || generic == kPresetVolumeKey);
        if (preset_ && !for_presets && (groups_.contains(top) || find_key(top)))
            return add_problem(line, concrete,
                               fmt::format("is not for presets; allowed are {}", fmt::join(kPresetKeys, ", ")));
        if (added_ && !is_of_added(generic))
            return add_problem(
                line, concrete,
                fmt::format("is not for one volume of several; allowed are {}", fmt::join(kAddedKeys, ", ")));
        if (!preset_ && generic == "volumes") return read_added(node, concrete, line);
        if (const SceneTable* table = find_table(generic)) return read_group(*table, node, concrete, line);
        if (const SceneKey* key = find_key(generic)) return read_key(*key, node, concrete, index, line);
        if (groups_.contains(generic)) {
            const toml::table* table = node.as_table();
            if (!table) return add_problem(line, concrete, text_of(node) + ": expected a table: [" + concrete + "]");
            return read_table(*table, concrete, generic, index);
        }
        add_problem(line, concrete, unknown_key(concrete));
    }

  private:
    static std::size_t line_of(const toml::key& key) { return key.source().begin.line; }

    static std::string text_of(const toml::node& node) {
        std::ostringstream out;
        if (node.is_table()) return "a table";
        node.visit([&out](const auto& concrete) { out << concrete; });
        std::string text = out.str();
        std::replace(text.begin(), text.end(), '\n', ' ');
        return text.size() > 80 ? text.substr(0, 77) + "..." : text;
    }

    /// The node as a list of at most `most` tables with the header [[path]]; null, with a problem, if it is none.
    const toml::array* tables_in(const toml::node& node, const std::string& path, std::size_t most,
                                 const std::string& concrete, std::size_t line) {
        const toml::array* array = node.as_array();
        const bool tables = array && std::all_of(array->begin(), array->end(), [](auto& n) { return n.is_table(); });
        if (!tables)
            add_problem(line, concrete, text_of(node) + ": expected a list of tables, each begun by [[" + path + "]]");
        else if (array->size() > most)
            add_problem(line, concrete, fmt::format("{} entries: expected at most {}", array->size(), most));
        else
            return array;
        return nullptr;
    }

    void read_group(const SceneTable& group, const toml::node& node, const std::string& concrete, std::size_t line) {
        if (!group.list) {
            const toml::table* table = node.as_table();
            if (!table) return add_problem(line, concrete, text_of(node) + ": expected a table: [" + concrete + "]");
            group.resize(document_, 1);
            return read_table(*table, concrete, group.path, 0);
        }
        const toml::array* array = tables_in(node, group.path, group.most, concrete, line);
        if (!array) return;
        group.resize(document_, 0);
        group.resize(document_, array->size());
        for (std::size_t i = 0; i < array->size(); ++i) {
            const std::string entry = fmt::format("{}[{}]", concrete, i);
            lines_[entry] = (*array)[i].source().begin.line;
            read_table(*(*array)[i].as_table(), entry, group.path + "[]", i);
        }
    }

    void read_added(const toml::node& node, const std::string& concrete, std::size_t line) {
        const toml::array* array = tables_in(node, "volumes", kMaxVolumes - 1, concrete, line);
        if (!array) return;
        document_.volumes.assign(array->size(), {});
        for (std::size_t i = 0; i < array->size(); ++i) {
            const std::string entry = fmt::format("{}[{}]", concrete, i);
            lines_[entry] = (*array)[i].source().begin.line;
            Reader reader(document_.volumes[i], false, true);
            reader.read_table(*(*array)[i].as_table(), "", "", 0);
            reader.apply();
            for (const auto& [path, at] : reader.lines_)
                lines_[fmt::format("{}.{}", entry, path)] = at;
            for (const Problem& problem : reader.problems_)
                add_problem(problem.line, "", fmt::format("{}.{}", entry, problem.text));
        }
    }

    void read_key(const SceneKey& key, const toml::node& node, const std::string& concrete, std::size_t index,
                  std::size_t line) {
        const std::optional<KeyValue> value = value_of(node, key);
        if (!value) return add_problem(line, concrete, text_of(node) + ": expected " + key.expectation());
        const std::string refusal = key.refusal(*value);
        if (!refusal.empty()) return add_problem(line, concrete, refusal);
        assignments_.push_back({&key, index, concrete, *value, line});
    }

    static bool append_numbers(const toml::array& array, bool nested, std::vector<double>& numbers) {
        for (auto&& item : array) {
            if (const toml::array* inner = item.as_array(); inner && nested) {
                if (inner->size() != 3 || !append_numbers(*inner, false, numbers)) return false;
            } else if (nested || !item.is_number()) {
                return false;
            } else {
                numbers.push_back(*item.value<double>());
            }
        }
        return true;
    }

    /// The node as a value of the key's type; nullopt if its type differs.
    static std::optional<KeyValue> value_of(const toml::node& node, const SceneKey& key) {
        const toml::array* array = node.as_array();
        switch (key.type) {
            case KeyType::Flag:
                return node.is_boolean() ? std::optional<KeyValue>(*node.value<bool>()) : std::nullopt;
            case KeyType::Number:
            case KeyType::Integer:
                return node.is_number() ? std::optional<KeyValue>(*node.value<double>()) : std::nullopt;
            case KeyType::Text:
                return node.is_string() ? std::optional<KeyValue>(*node.value<std::string>()) : std::nullopt;
            case KeyType::Texts: {
                // Numbers of labels are texts, too, so that 64 bits stay exact.
                const auto text = [](const toml::node& item) -> std::optional<std::string> {
                    if (item.is_integer()) return fmt::format("{}", *item.value<std::int64_t>());
                    return item.value_exact<std::string>();
                };
                std::vector<std::string> texts;
                if (!array) {
                    const auto one = text(node);
                    return one ? std::optional<KeyValue>(std::vector{*one}) : std::nullopt;
                }
                for (auto&& item : *array) {
                    const auto one = text(item);
                    if (!one) return std::nullopt;
                    texts.push_back(*one);
                }
                return texts;
            }
            default:
                break;
        }
        std::vector<double> numbers;
        if (!array || !append_numbers(*array, key.points, numbers)) return std::nullopt;
        return numbers;
    }

    SceneDocument& document_;
    bool preset_, added_;
    std::set<std::string> groups_;  ///< tables with keys, and their parents
    std::map<std::string, std::size_t> lines_;
    std::vector<Assignment> assignments_;
    std::vector<Problem> problems_;
};

[[noreturn]] void report(std::vector<Problem> problems, const std::string& name) {
    std::stable_sort(problems.begin(), problems.end(),
                     [](const Problem& a, const Problem& b) { return a.line < b.line; });
    std::vector<std::string> lines;
    for (const Problem& problem : problems)
        lines.push_back(fmt::format("{}:{}: {}", name, problem.line, problem.text));
    throw SceneFileError(std::move(lines));
}

}  // namespace

SceneFileError::SceneFileError(std::vector<std::string> problems)
    : Error(fmt::format("{}", fmt::join(problems, "\n"))), problems_(std::move(problems)) {}

std::vector<SceneTableProblem> read_scene_table(
    SceneDocument& document, const toml::table& table,
    const std::function<std::vector<DocumentProblem>(const SceneDocument&)>& check) {
    Reader reader(document, false);
    reader.read_table(table, "", "", 0);
    reader.apply();
    if (check)
        for (const DocumentProblem& problem : check(document))
            reader.add_problem(reader.line_of_path(problem.path), problem.path, problem.text);
    return std::move(reader.problems());
}

std::vector<SceneTableProblem> read_scene_node(SceneDocument& document, const toml::node& node, const std::string& path,
                                               std::size_t line) {
    Reader reader(document, false);
    reader.read_node(node, path, path, 0, line);
    reader.apply();
    return std::move(reader.problems());
}

bool is_scene_path(const fs::path& path) {
    return path.extension() == ".toml";
}

SceneDocument parse_scene(std::string_view text, const std::string& name, const SceneTextOptions& options) {
    if (const std::size_t bad = invalid_utf8(text); bad != std::string_view::npos) {
        const auto line =
            static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(bad), '\n')) +
            1;
        report({{line, fmt::format("byte {} is not valid UTF-8; a scene is a text file in TOML", bad)}}, name);
    }
    toml::table table;
    try {
        table = toml::parse(text, name);
    } catch (const toml::parse_error& error) {
        report({{error.source().begin.line, fmt::format("no valid TOML: {}", error.description())}}, name);
    }
    if (table.empty()) report({{1, "the file is empty; `edgesplat scene new VOLUME` writes a first scene"}}, name);
    SceneDocument document;
    Reader reader(document, options.preset);
    reader.read_table(table, "", "", 0);
    reader.apply();
    if (options.whole && !options.preset)
        for (const DocumentProblem& problem : problems_of(document, options.folders))
            reader.add_problem(reader.line_of_path(problem.path), problem.path, problem.text);
    if (!reader.problems().empty()) report(std::move(reader.problems()), name);
    return document;
}

SceneDocument read_scene_file(const fs::path& path) {
    std::string text;
    try {
        text = read_text_file(path, "a scene file");
    } catch (const Error& error) {
        throw SceneFileError({error.what()});
    }
    return parse_scene(text, path.string(), {.folders = volume_folders(path.parent_path())});
}

namespace {

/// The node of `text` for a key: parsed as TOML, else as a text or the inside of a list.
toml::table node_of(const SceneKey* key, std::string text) {
    const bool list =
        key && (key->type == KeyType::Numbers || key->type == KeyType::Integers || key->type == KeyType::Texts);
    const bool textual = key && (key->type == KeyType::Text || key->type == KeyType::Texts);
    if (key && key->type == KeyType::Text && !text.starts_with('"') && !text.starts_with('\''))
        return toml::table{{"v", text}};
    if (list && !text.starts_with('[')) {
        if (textual && text.starts_with('"')) return toml::parse("v = " + text);
        if (textual) {
            toml::array items;
            std::istringstream in(text);
            for (std::string item; std::getline(in, item, ',');)
                items.push_back(item);
            return toml::table{{"v", items}};
        }
        text = "[" + text + "]";
    }
    return toml::parse("v = " + text);
}

}  // namespace

namespace {

/// Sets a key of an entry of `volumes`; the first one behind the last is made. `rest`: "=VALUE".
void set_added(SceneDocument& document, const std::pair<std::size_t, std::string_view>& address,
               std::string_view rest) {
    const auto& [number, key] = address;
    if (number > document.volumes.size() || number + 1 >= kMaxVolumes)
        fail("volumes[{}]: there are {} volumes beside the first, expected an index from 0 to {}", number,
             document.volumes.size(), std::min(document.volumes.size(), kMaxVolumes - 2));
    SceneDocument entry = number < document.volumes.size() ? document.volumes[number] : SceneDocument{};
    try {
        set_key(entry, std::string(key) + std::string(rest));
    } catch (const Error& error) {
        fail("volumes[{}].{}", number, error.what());
    }
    if (number == document.volumes.size()) document.volumes.emplace_back();
    document.volumes[number] = std::move(entry);
}

}  // namespace

void set_key(SceneDocument& document, std::string_view assignment) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string_view::npos || equals == 0)
        fail("'{}' is not KEY=VALUE, such as effects.fog.density=0.02", assignment);
    // Every document must be writable as a scene file, which is UTF-8.
    if (const std::size_t bad = invalid_utf8(assignment); bad != std::string_view::npos)
        fail("{}: byte {} is not valid UTF-8", assignment.substr(0, equals), bad);
    const std::string path(assignment.substr(0, equals)), text(assignment.substr(equals + 1));
    if (const auto added = added_address(path)) return set_added(document, *added, assignment.substr(equals));
    const bool all_volumes = path == "volumes";
    const KeyAddress address = key_address(path);
    const SceneKey* key = find_key(address.path);
    const SceneTable* table = find_table(address.path);
    if (!key && !table && !all_volumes) fail("{}: {}", path, unknown_key(path));
    if (address.component && key) {
        double value = 0;
        std::istringstream in(text);
        if (!(in >> value) || !in.eof()) fail("{}: {}: expected a number", path, text);
        return set_number(document, path, value);
    }
    if (table && !table->list && (text == "true" || text == "false"))
        return table->resize(document, text == "true" ? 1 : 0);

    SceneDocument changed = document;
    if (key) {
        const std::string around = table_of(*key);
        const bool list = around.ends_with("[]");
        const SceneTable* group = find_table(list ? around.substr(0, around.size() - 2) : around);
        const std::size_t count = group ? group->count(changed) : 0;
        if (group && (address.index > count || address.index >= group->most))
            fail("{}: there are {} entries, expected an index from 0 to {}", path, count,
                 std::min(count, group->most - 1));
        if (group && address.index >= count) group->resize(changed, address.index + 1);
    }
    toml::table holder;
    try {
        holder = node_of(key, text);
    } catch (const toml::parse_error&) {
        fail("{}: {}: expected {}", path, text, key ? key->expectation() : "a TOML value");
    }
    Reader reader(changed, false);
    reader.read_node(*holder.get("v"), path, address.path, address.index, 1);
    if (!reader.problems().empty()) fail("{}", reader.problems().front().text);
    reader.apply();
    document = std::move(changed);
}

void animate_number(SceneDocument& document, std::string_view key, double value) {
    if (const auto added = added_address(key); added && added->first < document.volumes.size())
        return animate_number(document.volumes[added->first], added->second, value);
    const SceneKey* entry = find_key(key_address(key).path);
    const bool whole = entry && (entry->type == KeyType::Integer || entry->type == KeyType::Integers);
    const double number = whole ? std::round(value) : value;
    // A volume's keys may be open before; effects and list entries must exist.
    if (key.starts_with("volume."))
        set_key(document, fmt::format("{}={}", key, number));
    else
        set_number(document, key, number);
}

}  // namespace edgesplat
