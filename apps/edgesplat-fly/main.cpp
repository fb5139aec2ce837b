// edgesplat-fly: shows a volume from outside, like a model on a table, or from inside, like an endoscope.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "apps/device_options.h"
#include "apps/edgesplat-fly/app.h"
#include "apps/option_pages.h"
#include "apps/version.h"

namespace {

void print_script_help() {
    for (const auto& verb : edgesplat::viewer::script_verbs())
        fmt::print("{:<11}{}\n", verb.name, verb.help);
    fmt::print("\nValues: {}\n\nKeys and mouse:\n", value_names());
    for (const Shortcut& shortcut : shortcuts())
        fmt::print("{:<26}{}\n", shortcut.keys, shortcut.what);
}

void add_options(CLI::App& app, AppOptions& options) {
    app.add_option("SOURCE", options.source,
                   "A volume file, a folder of slices, builtin:NAME or a scene file (default: a builtin scene)");
    add_device_options(app, options.device);
    app.add_option_function<std::string>(
           "--size",
           [&options](const std::string& text) {
               const auto x = text.find('x');
               try {
                   options.size = {std::stoi(text.substr(0, x)), std::stoi(text.substr(x + 1))};
               } catch (const std::exception&) {
                   options.size = glm::ivec2(0);
               }
               if (x == std::string::npos || options.size.x < 1 || options.size.y < 1 || options.size.x > 16384 ||
                   options.size.y > 16384)
                   throw CLI::ValidationError("--size " + text, "expected WIDTHxHEIGHT, 1 to 16384 pixels each");
           },
           "Size of the window, pixels (default: as last time)")
        ->type_name("WxH");
    app.add_option("--target", options.target,
                   "Time limit of a picture while something moves, milliseconds (default: 33; 150 without a GPU)")
        ->check(CLI::Range(1.0, 10000.0));
    app.add_option_function<double>(
           "--memory-budget",
           [&options](double megabytes) { options.memory_budget = static_cast<std::uint64_t>(megabytes * 1048576); },
           "Limit of the device memory of a picture, MiB")
        ->check(CLI::PositiveNumber);
    auto* script = app.add_option("--script", options.script, "Replay input from a script, with a fixed time step");
    app.add_flag("--headless", options.headless, "Run without a window; needs --script")->needs(script);
    app.add_option("--record", options.record, "Record the input as a script")->excludes(script);
    app.add_flag("!--no-preferences", options.remember, "Neither read nor write the user's preferences");
    app.add_flag_callback(
        "--script-help",
        [] {
            print_script_help();
            throw CLI::Success();
        },
        "Print the commands, values and keys of scripts");
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Interactive volume splatting with edge preservation"};
    app.name("edgesplat-fly");
    app.set_version_flag("--version", version_text("edgesplat-fly"));
    add_page_options(app, EDGESPLAT_VERSION);
    AppOptions options;
    add_options(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        App(options).run();
    } catch (const std::exception& error) {
        fmt::print(stderr, "edgesplat-fly: {}\n", error.what());
        return 1;
    }
    return 0;
}
