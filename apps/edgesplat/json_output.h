// Writes the output of option --json.
#pragma once

#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/accuracy/json_text.h"
#include "engine/image/image_file.h"

/// Writes to stdout if `path` is "-", otherwise to that file, completely or not at all. Throws edgesplat::Error.
template <typename Json>
void write_json(const std::string& path, const Json& json) {
    const std::string text = edgesplat::json_text(json, 2) + "\n";
    if (path == "-") {
        std::cout << text;
        return;
    }
    const edgesplat::FileContent file{path, text};
    edgesplat::write_files({&file, 1});
}
