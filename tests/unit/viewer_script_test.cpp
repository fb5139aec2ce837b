#include "engine/viewer/script.h"

#include <gtest/gtest.h>

#include "engine/error.h"

namespace edgesplat::viewer {
namespace {

bool known_key(std::string_view name) {
    return name == "W" || name == "Home";
}

std::vector<ScriptCommand> parse(const char* text) {
    return parse_script(text, "a.txt", &known_key);
}

std::string script_refusal(const char* text) {
    try {
        parse(text);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(Script, ReadsCommandsAndSkipsComments) {
    const auto commands = parse("# a flight\nsize 640 480\n\n  hold W  \nkey Ctrl+W\r\nopen two words.nrrd\n");
    ASSERT_EQ(commands.size(), 4U);
    EXPECT_EQ(commands[0].verb, "size");
    EXPECT_EQ(commands[0].number(1), 480);
    EXPECT_EQ(commands[0].where, "a.txt:2");
    EXPECT_EQ(commands[1].words.front(), "W");
    EXPECT_EQ(commands[2].words.front(), "Ctrl+W");
    EXPECT_EQ(commands[3].words.front(), "two words.nrrd");
    EXPECT_EQ(commands[3].where, "a.txt:6");
}

TEST(Script, ExpectTakesAComparison) {
    const auto commands = parse("expect eye.x >= -3.5\nexpect message has two words");
    ASSERT_EQ(commands.size(), 2U);
    EXPECT_EQ(commands[0].words, (std::vector<std::string>{"eye.x", ">=", "-3.5"}));
    EXPECT_EQ(commands[1].words[2], "two words");
}

TEST(Script, RefusesWithFileAndLine) {
    EXPECT_EQ(script_refusal("frames 3\nfames 3"), "a.txt:2: 'fames' is not a command; did you mean frames?");
    EXPECT_EQ(script_refusal("move 3"), "a.txt:1: move: expected 2 words");
    EXPECT_EQ(script_refusal("move 3 x"), "a.txt:1: move: 'x', expected a number");
    EXPECT_EQ(script_refusal("move 3 nan"), "a.txt:1: move: 'nan', expected a number");
    EXPECT_EQ(script_refusal("frames 1e300"), "a.txt:1: frames: '1e300', expected a number from -1e9 to 1e9");
    EXPECT_EQ(script_refusal("move 1 2 3"), "a.txt:1: move: unexpected word '3', expected 2 words");
    EXPECT_NE(script_refusal("hold Q").find("a.txt:1: hold: 'Q', expected a key"), std::string::npos);
    EXPECT_NE(script_refusal("press upper").find("expected left, right or middle"), std::string::npos);
    EXPECT_NE(script_refusal("expect a = 1").find("expected =="), std::string::npos);
}

TEST(Script, ComparesNumbersAndText) {
    EXPECT_TRUE(holds("1.0", "==", "1"));
    EXPECT_TRUE(holds("2", ">", "1.5"));
    EXPECT_FALSE(holds("2", "<", "1.5"));
    EXPECT_TRUE(holds("2", "!=", "3"));
    EXPECT_TRUE(holds("wipe", "==", "wipe"));
    EXPECT_TRUE(holds("a long story", "has", "long"));
    EXPECT_FALSE(holds("text", ">=", "1"));
    EXPECT_FALSE(holds("nan", "<=", "1"));
}

TEST(Script, ParsesEveryVerb) {
    for (const ScriptVerb& verb : script_verbs()) {
        std::string line(verb.name);
        for (const char kind : verb.words)
            line += kind == 'n' ? " 1" : kind == 'k' ? " W" : kind == 'b' ? " left" : kind == 'c' ? " ==" : " word";
        const auto commands = parse_script(line, "a.txt", &known_key);
        ASSERT_EQ(commands.size(), 1U) << line;
        EXPECT_EQ(commands.front().words.size(), verb.words.size()) << line;
        EXPECT_FALSE(verb.help.empty());
    }
}

}  // namespace
}  // namespace edgesplat::viewer
