// Command lines, one argument per line: parsing up to the command's own work.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "apps/edgesplat/commands.h"
#include "engine/error.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    (void)edgesplat::fuzz::folder();
    std::vector<std::string> arguments;
    std::string_view rest = edgesplat::fuzz::text_of(data, size);
    while (!rest.empty() && arguments.size() < 64) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        arguments.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (arguments.back().starts_with("--list-devices")) return 0;  // queries the drivers
    }
    std::vector<const char*> argv{"edgesplat"};
    for (const std::string& argument : arguments)
        argv.push_back(argument.c_str());
    int exit_status = 0;
    CLI::App app("", "edgesplat");
    add_commands(app, "edgesplat", exit_status);
    app.parse_complete_callback([] { throw CLI::Success(); });  // runs before any command
    try {
        app.parse(static_cast<int>(argv.size()), argv.data());
    } catch (const CLI::ParseError&) {
    } catch (const edgesplat::Error&) {
    }
    return 0;
}
