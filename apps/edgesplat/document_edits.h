// Changes that command-line options make to a scene. Each option records an edit; all edits are applied, in the order
// of --help, after the scene is read.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "apps/edgesplat/option_values.h"
#include "engine/scene/scene_document.h"

class DocumentEdits {
  public:
    using Edit = std::function<void(edgesplat::SceneDocument&)>;

    void add(Edit edit) { edits_.push_back(std::move(edit)); }
    /// Applies all edits. Throws edgesplat::Error naming the option that does not fit the scene.
    void apply(edgesplat::SceneDocument& document) const {
        for (const Edit& edit : edits_)
            edit(document);
    }

  private:
    std::vector<Edit> edits_;
};

// Each function adds an option that records the edit `set(document, value)`. `edits` must outlive the parse. An invalid
// value throws CLI::ValidationError.

template <typename Set>
CLI::Option* add_number_edit(CLI::App& app, DocumentEdits& edits, const std::string& name, Range range,
                             const std::string& help, Set set) {
    const auto read = [&edits, name, range, set](const std::string& text) {
        edits.add([value = read_number(name, text, range), set](edgesplat::SceneDocument& d) { set(d, value); });
    };
    return app.add_option_function<std::string>(name, read, help)->type_name("NUMBER");
}

template <typename Set>
CLI::Option* add_vector_edit(CLI::App& app, DocumentEdits& edits, const std::string& name, const std::string& type,
                             const std::string& help, Set set) {
    const auto read = [&edits, name, type, set](const std::string& text) {
        edits.add([value = read_vector(name, text, type), set](edgesplat::SceneDocument& d) { set(d, value); });
    };
    return app.add_option_function<std::string>(name, read, help)->type_name(type);
}

template <typename Set>
CLI::Option* add_flag_edit(CLI::App& app, DocumentEdits& edits, const std::string& name, const std::string& help,
                           Set set) {
    return app.add_flag_callback(
        name, [&edits, set] { edits.add(set); }, help);
}
