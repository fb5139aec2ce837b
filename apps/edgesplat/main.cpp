// The command-line program: reads the arguments, runs one command and reports errors in one line each. Exit status: 0
// success, 1 failure (compare: the pictures differ), 2 wrong command line (compare: also if the comparison fails), 130
// stopped by Ctrl-C.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "apps/edgesplat/commands.h"
#include "apps/edgesplat/mpi_ranks.h"
#include "engine/error.h"
#include "engine/scene/nearest_name.h"

namespace {

/// The arguments as one line, quoted for a shell.
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

/// The option or command of `app` most similar to an unknown argument; empty if none is similar.
std::string nearest_name(const CLI::App& app, std::string argument) {
    argument.resize(std::min(argument.find('='), argument.size()));
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return edgesplat::nearest_name(argument, names);
}

/// Reports an error of the command line and returns the exit status.
int report_usage(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<CLI::App*> parsed = app.get_subcommands();
    const CLI::App& command = parsed.empty() ? app : *parsed.front();
    const std::vector<std::string> unexpected = app.remaining(true);
    if (parsed.empty() && !unexpected.empty())
        fmt::print(stderr, "edgesplat: {}error: unknown command or option '{}'\n", ranks::label(), unexpected.front());
    else
        fmt::print(stderr, "edgesplat: {}error: {}\n", ranks::label(), error.what());
    for (const std::string& argument : unexpected) {
        const std::string name = nearest_name(command, argument);
        if (!name.empty()) fmt::print(stderr, "Did you mean {}?\n", name);
    }
    fmt::print(stderr, "Try: edgesplat {}--help\n", parsed.empty() ? "" : command.get_name() + " ");
    return 2;
}

/// Prints one line per problem.
void print_error(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        fmt::print(stderr, "edgesplat: {}error: {}\n", ranks::label(), line);
}

/// Delays all ranks except the first: it reports an error that all ranks share, and then ends the others.
void delay_other_ranks() {
    if (!ranks::first()) std::this_thread::sleep_for(std::chrono::milliseconds(300));
}

/// Refuses several ranks for a command that does not divide its work.
void refuse_ranks(const CLI::App& command) {
    const std::string& name = command.get_name();
    if (ranks::count() > 1 && name != "movie")
        edgesplat::fail("{} does not divide its work among ranks, expected movie; run it without mpirun", name);
}

int run(int argc, char** argv) {
    int exit_status = 0;
    CLI::App app("Volume splatting with edge preservation", "edgesplat");
    try {
        add_commands(app, shell_line(argc, argv), exit_status);
        ranks::join();
        for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
            command->preparse_callback([command](std::size_t) { refuse_ranks(*command); });
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        delay_other_ranks();
        ranks::end_all(report_usage(app, error));
        return 2;
    } catch (const std::exception& error) {
        const int status = app.got_subcommand("compare") ? 2 : 1;
        delay_other_ranks();
        print_error(error.what());
        ranks::end_all(status);
        return status;
    }
    return exit_status;
}

}  // namespace

int main(int argc, char** argv) {
    const int status = run(argc, argv);
    ranks::leave();
    return status;
}
