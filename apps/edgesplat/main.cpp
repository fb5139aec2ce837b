// The command line program: reads the arguments, runs one command, and turns every error into one line and an exit
// status: 0 done, 1 it could not be done (compare: the pictures differ), 2 the command line is wrong (compare: or the
// pictures cannot be compared).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <numeric>
#include <string>
#include <vector>

#include "apps/edgesplat/accuracy_command.h"
#include "apps/edgesplat/compare_command.h"
#include "apps/edgesplat/footprints_command.h"
#include "apps/edgesplat/help_formatter.h"
#include "apps/edgesplat/info_command.h"
#include "apps/edgesplat/render_command.h"

namespace {

/// The arguments as one line that a shell would read back to the same.
std::string shell_line(int argc, char** argv) {
    constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+,./:@%";
    std::string line = "edgesplat";
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        line += ' ';
        if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) {
            line += argument;
            continue;
        }
        line += '\'';
        for (const char c : argument)
            line += c == '\'' ? "'\\''" : std::string(1, c);
        line += '\'';
    }
    return line;
}

/// Letters to insert, delete or replace to turn one word into the other.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
        }
    }
    return row.back();
}

/// The option or command of `app` that is spelled most like an unexpected argument; empty if none is near.
std::string nearest_name(const CLI::App& app, std::string argument) {
    argument = argument.substr(0, argument.find('='));
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(argument.size() / 3, 1) + 1;
    const auto consider = [&](const std::string& name) {
        const std::size_t distance = edit_distance(argument, name);
        if (distance < best_distance) {
            best_distance = distance;
            best = name;
        }
    };
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames())
            consider("--" + name);
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        consider(command->get_name());
    return best;
}

/// Reports what is wrong with the command line. Help and version come this way too, with status 0.
int report_usage(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    const std::vector<CLI::App*> parsed = app.get_subcommands();
    const CLI::App& command = parsed.empty() ? app : *parsed.front();
    const std::vector<std::string> unexpected = app.remaining(true);
    if (parsed.empty() && !unexpected.empty())
        fmt::print(stderr, "edgesplat: error: no command or option is called '{}'\n", unexpected.front());
    else
        fmt::print(stderr, "edgesplat: error: {}\n", error.what());
    for (const std::string& argument : unexpected) {
        const std::string name = nearest_name(command, argument);
        if (!name.empty()) fmt::print(stderr, "Did you mean {}?\n", name);
    }
    fmt::print(stderr, "Try: edgesplat {}--help\n", parsed.empty() ? "" : command.get_name() + " ");
    return 2;
}

}  // namespace

int main(int argc, char** argv) {
    int exit_status = 0;
    CLI::App app("Volume splatting with edge preservation", "edgesplat");
    try {
        app.set_version_flag("--version", "edgesplat " EDGESPLAT_VERSION);
        app.formatter(std::make_shared<HelpFormatter>());
        app.require_subcommand(1);
        app.add_flag_callback(
            "--list-devices",
            [] {
                print_devices();
                throw CLI::Success();
            },
            "Print the Vulkan devices and leave");
        add_render_command(app, shell_line(argc, argv));
        add_info_command(app);
        add_compare_command(app, exit_status);
        add_footprints_command(app);
        add_accuracy_command(app, shell_line(argc, argv), exit_status);
        app.footer(
            "Examples:\n"
            "  edgesplat render builtin:sphere -o sphere.png --compare plain\n"
            "  edgesplat info head.nrrd\n"
            "  edgesplat render head.nrrd --iso -400 -o head.png\n"
            "  edgesplat compare new.png old.png --max-diff 0.01\n"
            "Each command has a --help of its own.");
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return report_usage(app, error);
    } catch (const std::exception& error) {
        fmt::print(stderr, "edgesplat: error: {}\n", error.what());
        return app.got_subcommand("compare") ? 2 : 1;
    }
    return exit_status;
}
