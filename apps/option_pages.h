// Generates the manual page and shell completions from a program's options.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

/// The manual page (section 1, troff): every command and every option of `app`, by groups.
std::string man_page(const CLI::App& app, std::string_view version);

/// Completion script for `app`: commands, options, the named values of options ("a|b|c"), otherwise files. `shell` is
/// bash, zsh or fish; throws edgesplat::Error for any other.
std::string shell_completion(const CLI::App& app, std::string_view shell);

/// Adds --man and --completion SHELL, which print the text and end the program. `app` must outlive the parse.
void add_page_options(CLI::App& app, std::string_view version);
