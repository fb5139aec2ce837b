// Reads a Suite from TOML: a scene's table becomes one case for each of its modes and sizes.
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <sstream>

#include "engine/bench/suite.h"
#include "engine/scene/nearest_name.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/scene_table.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 4> kCameras{"far", "near", "grazing", "inside"};
constexpr std::int64_t kMaxPixels = 16384;

struct Mode {
    std::string name = "default";
    const toml::node* quality = nullptr;
    std::string path;  ///< in the file: "modes[1]"
};

std::string text_of(const toml::node& node) {
    if (node.is_table()) return "a table";
    std::ostringstream out;
    node.visit([&out](const auto& concrete) { out << concrete; });
    std::string text = out.str();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

bool is_name(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.' || c == ':';
    });
}

class SuiteReader {
  public:
    SuiteReader(Suite& suite, const std::vector<fs::path>& folders) : suite_(suite), folders_(folders) {}

    void read(const toml::table& table) {
        check_keys(table, "", {"about", "budget", "modes", "cases"});
        read_text(table, "", "about", suite_.about);
        if (const toml::node* budget = table.get("budget")) {
            const auto seconds = budget->value<double>();
            if (budget->is_number() && *seconds > 0 && *seconds <= 1e6)
                suite_.budget = *seconds;
            else
                add(*budget, "budget", "{}: expected a number of seconds above 0, at most 1000000", text_of(*budget));
        }
        for (const auto& [mode, path] : tables(table, "modes"))
            read_mode(*mode, path);
        if (modes_.empty()) modes_.emplace_back();
        if (!table.contains("cases")) add(table, "cases", "is missing; expected tables begun by [[cases]]");
        for (const auto& [entry, path] : tables(table, "cases"))
            read_case(*entry, path);
    }

    /// Throws SceneFileError if anything is wrong.
    void report() {
        if (problems_.empty()) return;
        std::stable_sort(problems_.begin(), problems_.end(),
                         [](const auto& a, const auto& b) { return a.line < b.line; });
        std::vector<std::string> lines;
        for (const SceneTableProblem& problem : problems_) {
            std::string line = fmt::format("{}:{}: {}", suite_.file, problem.line, problem.text);
            // A scene is read once for each mode, with the same problems each time.
            if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(std::move(line));
        }
        throw SceneFileError(std::move(lines));
    }

  private:
    template <typename... Args>
    void add(const toml::node& node, const std::string& path, fmt::format_string<Args...> format, Args&&... args) {
        const std::size_t line = std::max<std::size_t>(node.source().begin.line, 1);
        problems_.push_back({line, path + ": " + fmt::format(format, std::forward<Args>(args)...)});
    }

    static std::string inside(const std::string& path, std::string_view key) {
        return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
    }

    void check_keys(const toml::table& table, const std::string& path, const std::vector<std::string>& known) {
        for (auto&& [key, node] : table) {
            const std::string name(key.str());
            if (std::find(known.begin(), known.end(), name) != known.end()) continue;
            const std::string nearest = nearest_name(name, known);
            problems_.push_back({key.source().begin.line,
                                 fmt::format("{}: unknown key; {}", inside(path, name),
                                             nearest.empty() ? fmt::format("expected {}", fmt::join(known, ", "))
                                                             : "did you mean " + inside(path, nearest) + "?")});
        }
    }

    /// Reads a text; false if there is none.
    bool read_text(const toml::table& table, const std::string& path, std::string_view key, std::string& text) {
        const toml::node* node = table.get(key);
        if (node == nullptr) return false;
        const auto value = node->value<std::string>();
        if (!value)
            add(*node, inside(path, key), "{}: expected a text", text_of(*node));
        else
            text = *value;
        return value.has_value();
    }

    bool read_name(const toml::table& table, const std::string& path, std::string_view key, std::string& name) {
        if (!read_text(table, path, key, name)) return false;
        if (is_name(name)) return true;
        add(*table.get(key), inside(path, key), "\"{}\": expected letters, digits and - _ . :", name);
        return false;
    }

    std::vector<std::pair<const toml::table*, std::string>> tables(const toml::table& table, const std::string& key) {
        std::vector<std::pair<const toml::table*, std::string>> found;
        const toml::node* node = table.get(key);
        if (node == nullptr) return found;
        const toml::array* array = node->as_array();
        const bool all = array && std::all_of(array->begin(), array->end(), [](auto& n) { return n.is_table(); });
        if (!all || array->empty()) {
            add(*node, key, "{}: expected a list of tables, each begun by [[{}]]", text_of(*node), key);
            return found;
        }
        for (std::size_t i = 0; i < array->size(); ++i)
            found.emplace_back((*array)[i].as_table(), fmt::format("{}[{}]", key, i));
        return found;
    }

    void add_scene_problems(const std::vector<SceneTableProblem>& problems, const std::string& path) {
        for (const SceneTableProblem& problem : problems)
            problems_.push_back({problem.line, inside(path, problem.text)});
    }

    void read_mode(const toml::table& table, const std::string& path) {
        check_keys(table, path, {"name", "quality"});
        Mode mode{{}, table.get("quality"), path};
        if (!table.contains("name")) add(table, inside(path, "name"), "is missing; expected a name");
        if (!read_name(table, path, "name", mode.name)) return;
        const bool known =
            std::any_of(modes_.begin(), modes_.end(), [&](const Mode& m) { return m.name == mode.name; });
        if (known)
            return add(*table.get("name"), inside(path, "name"), "\"{}\": an earlier mode has this name", mode.name);
        SceneDocument unused;
        if (mode.quality != nullptr) add_scene_problems(apply(mode, unused), path);
        modes_.push_back(std::move(mode));
    }

    static std::vector<SceneTableProblem> apply(const Mode& mode, SceneDocument& document) {
        if (mode.quality == nullptr) return {};
        return read_scene_node(document, *mode.quality, "quality", mode.quality->source().begin.line);
    }

    std::vector<glm::ivec2> sizes_of(const toml::table& table, const std::string& path) {
        const toml::node* node = table.get("sizes");
        if (node == nullptr) return {{512, 512}};
        std::vector<glm::ivec2> sizes;
        const toml::array* list = node->as_array();
        bool good = list && !list->empty();
        for (std::size_t i = 0; good && i < list->size(); ++i) {
            const toml::array* pair = (*list)[i].as_array();
            good = pair && pair->size() == 2;
            glm::ivec2 size(0);
            for (int axis = 0; good && axis < 2; ++axis) {
                const toml::node& item = (*pair)[static_cast<std::size_t>(axis)];
                const auto pixels = item.is_integer() ? item.value<std::int64_t>() : std::nullopt;
                good = pixels && *pixels >= 1 && *pixels <= kMaxPixels;
                if (good) size[axis] = static_cast<int>(*pixels);
            }
            sizes.push_back(size);
        }
        if (good) return sizes;
        add(*node, inside(path, "sizes"), "{}: expected a list of [width, height], each 1 to {} pixels", text_of(*node),
            kMaxPixels);
        return {};
    }

    std::vector<Mode> modes_of(const toml::table& table, const std::string& path) {
        const toml::node* node = table.get("modes");
        if (node == nullptr) return modes_;
        std::vector<std::string> names;
        for (const Mode& mode : modes_)
            names.push_back(mode.name);
        std::vector<Mode> chosen;
        const toml::array* list = node->as_array();
        for (std::size_t i = 0; list && i < list->size(); ++i) {
            const auto name = (*list)[i].value<std::string>();
            const auto mode =
                std::find_if(modes_.begin(), modes_.end(), [&](const Mode& m) { return name && m.name == *name; });
            if (mode == modes_.end())
                add((*list)[i], fmt::format("{}.modes[{}]", path, i), "{}: expected one of {}", text_of((*list)[i]),
                    fmt::join(names, ", "));
            else
                chosen.push_back(*mode);
        }
        if (!list || list->empty())
            add(*node, inside(path, "modes"), "{}: expected a list of {}", text_of(*node), fmt::join(names, ", "));
        return chosen;
    }

    void read_case(const toml::table& table, const std::string& path) {
        check_keys(table, path, {"name", "about", "camera", "series", "sizes", "modes", "scene"});
        SuiteCase made;
        read_text(table, path, "about", made.about);
        if (!table.contains("name")) add(table, inside(path, "name"), "is missing; expected a name");
        const bool named = read_name(table, path, "name", made.group);
        if (named && !names_.insert(made.group).second)
            add(*table.get("name"), inside(path, "name"), "\"{}\": an earlier case has this name", made.group);
        read_name(table, path, "series", made.series);
        if (read_text(table, path, "camera", made.camera) &&
            std::find(kCameras.begin(), kCameras.end(), made.camera) == kCameras.end())
            add(*table.get("camera"), inside(path, "camera"),
                "\"{}\": expected one of {}; use scene.camera for other cameras", made.camera,
                fmt::join(kCameras, ", "));
        const std::vector<glm::ivec2> sizes = sizes_of(table, path);
        const std::vector<Mode> modes = modes_of(table, path);
        const toml::node* scene = table.get("scene");
        if (scene == nullptr || !scene->is_table())
            return add(scene == nullptr ? table : *scene, inside(path, "scene"),
                       "expected a table with the keys of a scene file: [cases.scene]");
        for (const char* key : {"output", "movie"})
            if (const toml::node* node = scene->as_table()->get(key))
                add(*node, fmt::format("{}.scene.{}", path, key), "is not for suites; use {}.sizes for sizes", path);
        if (made.camera.empty() || !scene->as_table()->contains("camera"))
            add_case(made, *scene->as_table(), path, sizes, modes);
        else
            add(*table.get("camera"), inside(path, "camera"),
                "\"{}\": scene.camera is given, too; expected only one of them", made.camera);
    }

    void add_case(const SuiteCase& like, const toml::table& scene, const std::string& path,
                  const std::vector<glm::ivec2>& sizes, const std::vector<Mode>& modes) {
        std::string missing;
        SceneDocument document;
        const auto check = [&](const SceneDocument& read) {
            std::vector<DocumentProblem> problems = problems_of(read, folders_);
            // A missing file is not an error of the suite.
            if (read.volume.path.empty() || is_builtin(read.volume.path)) return problems;
            std::erase_if(problems, [&](const DocumentProblem& problem) {
                if (problem.path != "volume.path") return false;
                missing = problem.text;
                return true;
            });
            return problems;
        };
        add_scene_problems(read_scene_table(document, scene, check), inside(path, "scene"));
        for (const Mode& mode : modes) {
            for (const glm::ivec2& size : sizes) {
                SuiteCase made = like;
                made.mode = mode.name;
                made.name = fmt::format("{}/{}/{}x{}", like.group, mode.name, size.x, size.y);
                made.document = document;
                (void)apply(mode, made.document);
                made.document.output.size = size;
                if (missing.empty())
                    suite_.cases.push_back(std::move(made));
                else
                    suite_.skipped.push_back({made.name, missing});
            }
        }
    }

    Suite& suite_;
    const std::vector<fs::path>& folders_;
    std::vector<Mode> modes_;
    std::set<std::string> names_;
    std::vector<SceneTableProblem> problems_;
};

}  // namespace

Suite parse_suite(std::string_view text, const std::string& file, const std::vector<fs::path>& folders) {
    toml::table table;
    try {
        table = toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        throw SceneFileError(
            {fmt::format("{}:{}: no valid TOML: {}", file, error.source().begin.line, error.description())});
    }
    Suite suite;
    suite.file = file;
    suite.name = fs::path(file).stem().string();
    SuiteReader reader(suite, folders);
    reader.read(table);
    reader.report();
    return suite;
}

}  // namespace edgesplat::bench
