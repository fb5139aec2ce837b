#include "apps/option_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "engine/error.h"

namespace {

using Options = std::vector<const CLI::Option*>;

/// Commands in the order of --help.
std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App* command) { return !command->get_name().empty(); });
}

/// Options that --help shows, without positional ones.
Options options_of(const CLI::App& app) {
    return app.get_options(
        [](const CLI::Option* option) { return option->nonpositional() && !option->get_group().empty(); });
}

/// "-o" and "--output".
std::vector<std::string> names_of(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames())
        names.push_back("-" + name);
    for (const std::string& name : option.get_lnames())
        names.push_back("--" + name);
    return names;
}

bool takes_value(const CLI::Option& option) {
    return option.get_items_expected_max() > 0 && option.get_type_size_max() > 0;
}

/// The values of "a|b|c"; empty if the type is not a list of names.
std::vector<std::string> choices_of(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    if (type.find('|') == std::string::npos) return {};
    std::vector<std::string> choices;
    std::istringstream in(type);
    for (std::string choice; std::getline(in, choice, '|');)
        if (choice.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ,: ") == std::string::npos) choices.push_back(choice);
    return choices;
}

std::string one_line(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    return text;
}

/// Escapes a text for troff: backslashes, dashes (no line break at them), and lines that would be requests.
std::string troff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
            out += std::string("\\&") + c;
        else
            out += c;
    }
    return out;
}

std::string troff_option(const CLI::Option& option, const std::string& name) {
    std::string text = ".TP\n\\fB" + troff(name) + "\\fR";
    if (!option.get_type_name().empty() && takes_value(option))
        text += " \\fI" + troff(option.get_type_name()) + "\\fR";
    text += "\n" + troff(one_line(option.get_description()));
    if (option.get_required()) text += " (required)";
    if (!option.get_default_str().empty()) text += " (default: " + troff(option.get_default_str()) + ")";
    return text + "\n";
}

std::string troff_options(const CLI::App& app) {
    std::string text;
    for (const CLI::Option* option : app.get_options([](const CLI::Option* o) { return o->get_positional(); }))
        text += troff_option(*option, option->get_name(true));
    std::vector<std::string> groups;
    for (const CLI::Option* option : options_of(app))
        if (std::ranges::count(groups, option->get_group()) == 0) groups.push_back(option->get_group());
    for (const std::string& group : groups) {
        if (groups.size() > 1) text += ".PP\n" + troff(group) + ":\n";
        for (const CLI::Option* option : options_of(app))
            if (option->get_group() == group)
                text += troff_option(*option, fmt::format("{}", fmt::join(names_of(*option), ", ")));
    }
    return text;
}

std::string troff_footer(const CLI::App& app) {
    const std::string footer = app.get_footer();
    return footer.empty() ? "" : ".PP\n.nf\n" + troff(footer) + "\n.fi\n";
}

void add_commands_to(std::string& text, const CLI::App& app, const std::string& prefix) {
    for (const CLI::App* command : commands_of(app)) {
        const std::string name = prefix + command->get_name();
        text += fmt::format(".SH \"{}\"\n{}\n{}{}", troff(name), troff(command->get_description()),
                            troff_options(*command), troff_footer(*command));
        add_commands_to(text, *command, name + " ");
    }
}

std::string identifier(std::string name) {
    std::ranges::replace_if(
        name, [](char c) { return c == '-' || c == ' '; }, '_');
    return name;
}

/// Collects every command with its words, such as "scene new"; the program itself has none.
void collect(const CLI::App& app, const std::string& words, std::vector<std::pair<std::string, const CLI::App*>>& out) {
    out.emplace_back(words, &app);
    for (const CLI::App* command : commands_of(app))
        collect(*command, words.empty() ? command->get_name() : words + " " + command->get_name(), out);
}

/// Words that may follow a command.
std::string words_after(const CLI::App& app) {
    std::vector<std::string> words;
    for (const CLI::App* command : commands_of(app))
        words.push_back(command->get_name());
    for (const CLI::Option* option : options_of(app))
        for (const std::string& name : names_of(*option))
            words.push_back(name);
    return fmt::format("{}", fmt::join(words, " "));
}

std::string bash_completion(const CLI::App& app) {
    const std::string function = "_" + identifier(app.get_name());
    std::vector<std::pair<std::string, const CLI::App*>> all;
    collect(app, "", all);
    std::string words, values;
    for (const auto& [path, command] : all) {
        words += fmt::format("        '{}') words='{}' ;;\n", path, words_after(*command));
        for (const CLI::Option* option : options_of(*command))
            if (takes_value(*option))
                for (const std::string& name : names_of(*option))
                    values += fmt::format("        '{} {}') values='{}' ;;\n", path, name,
                                          fmt::join(choices_of(*option), " "));
    }
    // The script derives the command from the words before the cursor and skips words that are not commands.
    return fmt::format(R"(# Completion of {0} for bash, made from its options.
{1}() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} path= next words= offered= values=none i
    COMPREPLY=()
    for ((i = 1; i < COMP_CWORD; i++)); do
        next="${{path:+$path }}${{COMP_WORDS[i]}}"
        case $next in
{2}        *) continue ;;
        esac
        path=$next
    done
    case "$path $before" in
{3}    esac
    if [ "$values" != none ]; then
        if [ -n "$values" ]; then mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word"); fi
        return
    fi
    case $path in
{4}    esac
    for next in $words; do
        if [[ $word == -* || $next != -* ]]; then offered+=" $next"; fi
    done
    mapfile -t COMPREPLY < <(compgen -W "$offered" -- "$word")
}}
complete -o default -F {1} {0}
)",
                       app.get_name(), function,
                       [&] {
                           std::string known;
                           for (const auto& [path, command] : all)
                               if (!path.empty()) known += fmt::format("        '{}') ;;\n", path);
                           return known;
                       }(),
                       values, words);
}

/// Quotes a text for a shell, with single quotes.
std::string in_quotes(const std::string& text) {
    std::string out = "'";
    for (const char c : text)
        out += c == '\'' ? "'\\''" : std::string(1, c);
    return out + "'";
}

std::string zsh_completion(const CLI::App& app) {
    const auto described = [](const std::string& name, std::string help) {
        for (const char c : std::string("[]:"))
            std::ranges::replace(help, c, c == ':' ? ';' : c == '[' ? '(' : ')');
        return std::pair(name, one_line(std::move(help)));
    };
    const auto arguments = [&](const CLI::App& command) {
        std::string text;
        for (const CLI::Option* option : options_of(command))
            for (const std::string& name : names_of(*option)) {
                const auto [n, help] = described(name, option->get_description());
                const std::vector<std::string> choices = choices_of(*option);
                std::string value;
                if (takes_value(*option))
                    value = choices.empty() ? ":value:_files" : fmt::format(":value:({})", fmt::join(choices, " "));
                text += fmt::format(" \\\n            {}", in_quotes(fmt::format("*{}[{}]{}", n, help, value)));
            }
        return text;
    };
    std::vector<std::pair<std::string, const CLI::App*>> all;
    collect(app, "", all);
    std::string cases;
    for (const auto& [path, command] : all) {
        std::string names;
        for (const CLI::App* inner : commands_of(*command)) {
            const auto [n, help] = described(inner->get_name(), inner->get_description());
            names += " " + in_quotes(fmt::format("{}:{}", n, help));
        }
        if (!names.empty())
            names = fmt::format("            local -a commands=({})\n            _describe command commands\n", names);
        cases += fmt::format("        '{}')\n{}            _arguments '*:file:_files'{}\n            ;;\n", path, names,
                             arguments(*command));
    }
    return fmt::format(R"(#compdef {0}
# Completion of {0} for zsh, made from its options.
_{1}() {{
    local path= word
    for word in ${{words[2,CURRENT-1]}}; do
        case "${{path:+$path }}$word" in
{2}        esac
    done
    case $path in
{3}    esac
}}
_{1} "$@"
)",
                       app.get_name(), identifier(app.get_name()),
                       [&] {
                           std::string known;
                           for (const auto& [path, command] : all)
                               if (!path.empty()) known += fmt::format("        '{0}') path='{0}' ;;\n", path);
                           return known;
                       }(),
                       cases);
}

std::string fish_completion(const CLI::App& app) {
    std::string text = fmt::format("# Completion of {} for fish, made from its options.\n", app.get_name());
    std::vector<std::pair<std::string, const CLI::App*>> all;
    collect(app, "", all);
    for (const auto& [path, command] : all) {
        std::string condition = "__fish_use_subcommand";
        if (!path.empty() || commands_of(app).empty()) {
            std::vector<std::string> seen;
            std::istringstream in(path);
            for (std::string word; in >> word;)
                seen.push_back("__fish_seen_subcommand_from " + word);
            condition = fmt::format("{}", fmt::join(seen, "; and "));
        }
        const std::string start =
            fmt::format("complete -c {}{}", app.get_name(), condition.empty() ? "" : " -n " + in_quotes(condition));
        for (const CLI::App* inner : commands_of(*command))
            text += fmt::format("{} -f -a {} -d {}\n", start, inner->get_name(), in_quotes(inner->get_description()));
        for (const CLI::Option* option : options_of(*command)) {
            text += start;
            for (const std::string& name : option->get_snames())
                text += " -s " + name;
            for (const std::string& name : option->get_lnames())
                text += " -l " + name;
            const std::vector<std::string> choices = choices_of(*option);
            if (!choices.empty())
                text += fmt::format(" -x -a {}", in_quotes(fmt::format("{}", fmt::join(choices, " "))));
            else if (takes_value(*option))
                text += " -r";
            text += " -d " + in_quotes(one_line(option->get_description())) + "\n";
        }
    }
    return text;
}

}  // namespace

std::string man_page(const CLI::App& app, std::string_view version) {
    std::string name = app.get_name();
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    const bool commands = !commands_of(app).empty();
    std::string text = fmt::format(
        ".TH {0} 1 \"\" \"Edgesplat {1}\" \"User Commands\"\n.SH NAME\n{2} \\- {3}\n.SH SYNOPSIS\n.B {2}\n{4}\n"
        ".SH OPTIONS\n{5}",
        troff(name), version, troff(app.get_name()), troff(app.get_description()),
        commands ? "\\fICOMMAND\\fR [\\fIOPTIONS\\fR]" : "[\\fIOPTIONS\\fR] [\\fISOURCE\\fR]", troff_options(app));
    add_commands_to(text, app, "");
    if (!app.get_footer().empty()) text += ".SH EXAMPLES\n" + troff_footer(app);
    return text;
}

std::string shell_completion(const CLI::App& app, std::string_view shell) {
    if (shell == "bash") return bash_completion(app);
    if (shell == "zsh") return zsh_completion(app);
    if (shell == "fish") return fish_completion(app);
    edgesplat::fail("'{}' is not bash, zsh or fish", shell);
}

void add_page_options(CLI::App& app, std::string_view version) {
    app.add_flag_callback(
        "--man",
        [&app, version = std::string(version)] {
            fmt::print("{}", man_page(app, version));
            throw CLI::Success();
        },
        "Print the manual page (troff) and exit");
    app.add_option_function<std::string>(
           "--completion",
           [&app](const std::string& shell) {
               std::string text;
               try {
                   text = shell_completion(app, shell);
               } catch (const edgesplat::Error& error) {
                   throw CLI::ValidationError("--completion", error.what());
               }
               fmt::print("{}", text);
               throw CLI::Success();
           },
           "Print the completion script of a shell and exit")
        ->type_name("bash|zsh|fish");
}
