// Scenes: access to every key of a scene file, with the same error messages as files and the command line.
#include "engine/error.h"
#include "engine/scene/label_fade.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/scene_keys.h"
#include "engine/scene/scene_presets.h"
#include "engine/volume/labels.h"
#include "python/src/bindings.h"

namespace edgesplat::python {
namespace {

/// The value of a key; None if the scene leaves it open. For an optional table: whether it exists. For a list of
/// tables: their number.
py::object value_at(const Document& self, const std::string& path) {
    if (path == "volumes") return py::cast(self.scene.volumes.size());
    if (const auto added = added_address(path)) {
        const auto& [number, key] = *added;
        if (number >= self.scene.volumes.size()) return py::none();
        return value_at({self.scene.volumes[number], self.folders}, std::string(key));
    }
    const KeyAddress address = key_address(path);
    if (address.component) return py::cast(number_at(self.scene, path));
    if (const SceneTable* table = find_table(address.path)) {
        const std::size_t count = table->count(self.scene);
        return table->list ? py::cast(count) : py::cast(count > 0);
    }
    const SceneKey* key = find_key(address.path);
    if (!key) {
        const std::string nearest = nearest_key(path);
        fail("{}: unknown key{}", path, nearest.empty() ? "" : "; did you mean " + nearest + "?");
    }
    const std::string around = table_of(*key);
    const SceneTable* group = find_table(around.ends_with("[]") ? around.substr(0, around.size() - 2) : around);
    if (group && group->count(self.scene) <= address.index) return py::none();
    const std::optional<KeyValue> value = key->get(self.scene, address.index);
    if (!value) return py::none();
    if (key->type == KeyType::Integer) return py::cast(static_cast<long long>(std::get<double>(*value)));
    if (key->type == KeyType::Integers) {
        const auto& numbers = std::get<std::vector<double>>(*value);
        return py::cast(std::vector<long long>(numbers.begin(), numbers.end()));
    }
    return std::visit([](const auto& held) -> py::object { return py::cast(held); }, *value);
}

/// "table", "tables" (a list of tables), "key", "group" (of keys and tables), or "" for an unknown path.
std::string kind_of(const std::string& path) {
    if (path == "volumes") return "tables";
    if (const auto added = added_address(path)) return kind_of(std::string(added->second));
    const KeyAddress address = key_address(path);
    if (const SceneTable* table = find_table(address.path)) return table->list ? "tables" : "table";
    if (find_key(address.path)) return "key";
    const std::string inside = address.path + ".";
    for (const SceneKey& key : scene_keys())
        if (key.path.starts_with(inside)) return "group";
    return "";
}

std::vector<py::dict> keys() {
    std::vector<py::dict> all;
    for (const SceneKey& key : scene_keys()) {
        py::dict entry;
        entry["path"] = key.path;
        entry["help"] = key.help;
        entry["expected"] = key.expectation();
        entry["default"] = key.default_value ? toml_text(*key.default_value, key.type) : key.absent;
        all.push_back(std::move(entry));
    }
    return all;
}

Document parsed(const std::string& text, const std::string& name) {
    return {parse_scene(text, name, {.folders = {}, .whole = false}), volume_folders({})};
}

Document read(const std::string& path) {
    return {read_scene_file(path), volume_folders(std::filesystem::path(path).parent_path())};
}

/// The volume after the scene's preprocessing: threshold or labels, box filter, crop. `self` must be read. If labels of
/// a scan are chosen, open iso-values of the scene become those of the whole scan.
SharedVolume preprocessed_for(Document& self, const SharedVolume& given) {
    if (given.volume->has_segmentation() && chooses_labels(self.scene.volume))
        set_open_iso_values(self.scene, *given.volume);
    SceneDocument scene = self.scene;
    VolumeSource& asked = scene.volume;
    if (asked.label_names.empty()) asked.label_names = given.source.label_names;
    Volume named;
    const Volume* volume = given.volume.get();
    if (asked.label_names != given.source.label_names) {
        named = *volume;
        name_labels(named, find_file(asked.label_names, self.folders));
        volume = &named;
    }
    const VolumeSource open = asked;
    choose_labels(scene, *volume);
    VolumeSource unchanged = reading_part(asked);
    unchanged.labels = false;
    if (!asked.labels) asked.labels = false;
    if (asked == unchanged && !(volume->labels && has_ranks(*volume->labels))) return given;
    const std::lock_guard lock(given.latest->mutex);
    if (!given.latest->volume || given.latest->source != asked || given.latest->iso_values != scene.iso_values) {
        given.latest->source = asked;
        given.latest->iso_values = scene.iso_values;
        asked.labels = open.labels;
        given.latest->volume = std::make_shared<const Volume>(prepared_volume(scene, *volume));
    }
    return {given.latest->volume, given.source, given.latest};
}

/// Reads the volumes beside the first one. An entry without a path is of the first one's file, or array.
void read_others(Document& self, const SharedVolume& given) {
    SceneDocument scene = self.scene;
    const std::string& names = self.scene.volume.label_names;
    scene.volume = given.source;
    Volume named;
    if (!names.empty() && names != given.source.label_names) {
        scene.volume.label_names = names;
        named = *given.volume;
        name_labels(named, find_file(names, self.folders));
    }
    for (SceneDocument& entry : scene.volumes)
        if (entry.volume.path.empty()) read_as(entry.volume, scene.volume);
    read_volumes(scene, self.folders, {}, named.values.empty() ? given.volume.get() : &named);
    self.scene.volumes = std::move(scene.volumes);
}

/// The volume as the scene draws it: preprocessed, and cut by others.
SharedVolume prepared(Document& self, const SharedVolume& given) {
    const py::gil_scoped_release release;
    if (!self.scene.volumes.empty()) read_others(self, given);
    SharedVolume drawn = preprocessed_for(self, given);
    drawn.volume = self.cuts.apply(self.scene, drawn.volume);
    return drawn;
}

}  // namespace

void add_scenes(py::module_& module) {
    py::class_<Document>(module, "Document")
        .def(py::init([] {
            return Document{{}, volume_folders({})};
        }))
        .def_static("read", read)
        .def_static("parse", parsed)
        .def("copy", [](const Document& self) { return self; })
        .def("set", [](Document& self, const std::string& assignment) { set_key(self.scene, assignment); })
        .def("get", value_at)
        .def("fade", [](Document& self, const std::string& labels,
                        double opacity) { fade_labels(self.scene, labels, opacity); })
        .def("apply_look", [](Document& self, const std::string& name) { apply_look(self.scene, name); })
        .def("clear_camera", [](Document& self) { self.scene.camera = {}; })
        .def("text", [](const Document& self,
                        bool comments) { return comments ? commented_scene_text(self.scene) : scene_text(self.scene); })
        .def("problems",
             [](const Document& self) {
                 std::vector<std::pair<std::string, std::string>> found;
                 for (const DocumentProblem& problem : problems_of(self.scene, self.folders))
                     found.emplace_back(problem.path, problem.text);
                 return found;
             })
        .def("load", [](const Document& self) { return read_from(reading_part(self.scene.volume), self.folders); })
        .def("prepared", prepared)
        .def("__eq__", [](const Document& a, const Document& b) { return a.scene == b.scene; });
    module.def("kind_of", kind_of);
    module.def("scene_keys", keys);
}

}  // namespace edgesplat::python
