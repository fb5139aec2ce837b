// Man pages and shell completion, made from a program's options: what --help says, said once more in four languages.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

/// The manual page in section 1, in troff: every command and every option of `app`, by its groups.
std::string man_page(const CLI::App& app, std::string_view version);

/// What a shell reads to complete a command line of `app`: commands, options, the values of options that have names
/// ("a|b|c"), else files. `shell` is bash, zsh or fish; throws edgesplat::Error for any other.
std::string shell_completion(const CLI::App& app, std::string_view shell);

/// --man and --completion SHELL, which print them and end the program. `app` must live as long as it is parsed.
void add_page_options(CLI::App& app, std::string_view version);
