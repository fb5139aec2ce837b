// Viewer scripts: every accepted command has the words that its verb requires.
#include <cmath>
#include <cstdlib>

#include "engine/error.h"
#include "engine/viewer/script.h"
#include "tests/fuzz/fuzz_file.h"

using namespace edgesplat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<viewer::ScriptCommand> commands;
    try {
        commands = viewer::parse_script(fuzz::text_of(data, size), "script.txt",
                                        [](std::string_view key) { return key == "W" || key == "Home"; });
    } catch (const Error&) {
        return 0;
    }
    for (const viewer::ScriptCommand& command : commands)
        for (const viewer::ScriptVerb& verb : viewer::script_verbs()) {
            if (verb.name != command.verb) continue;
            if (verb.words.size() != command.words.size()) std::abort();
            for (std::size_t i = 0; i < verb.words.size(); ++i)
                if (verb.words[i] == 'n' && !std::isfinite(command.number(i))) std::abort();
            if (verb.words == "wct") (void)viewer::holds(command.words[0], command.words[1], command.words[2]);
        }
    return 0;
}
