// Looks and transfer functions by name, the warning of an eye in matter, manual page, completion and version.
#include <gmock/gmock.h>

#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class CliLooks : public CliTest {
  protected:
    ProgramRun render(const std::string& arguments) const {
        return run("render builtin:phantom:24 -o a.png --size 24x24 " + arguments);
    }
};

TEST_F(CliLooks, AcceptsLooksByName) {
    EXPECT_EQ(render("--look ct-skin-bone").status, 0);
    EXPECT_EQ(render("--transfer ct-soft-tissue-and-bone").status, 0);
    EXPECT_THAT(run("scene new builtin:phantom:24 --look ct-skin-bone").out,
                AllOf(HasSubstr("iso_values = [-300.0, 280.0]"), HasSubstr("extinction = 0.03")));
    const ProgramRun nearly = render("--look ct-skin-bones");
    EXPECT_EQ(nearly.status, 2);
    EXPECT_THAT(nearly.err, HasSubstr("did you mean \"ct-skin-bone\"?"));
    const ProgramRun material = render("--transfer ct-bone");
    EXPECT_EQ(material.status, 2);
    EXPECT_THAT(material.err, HasSubstr("\"ct-bone\" is not a transfer function"));
    EXPECT_EQ(render("--labels yes").status, 2);
    EXPECT_THAT(run("scene presets").out, AllOf(HasSubstr("look"), HasSubstr("ct-skull"), HasSubstr("angiography")));
}

TEST_F(CliLooks, WarnsOfEyeInMatter) {
    const ProgramRun inside =
        run("render builtin:sphere:16 -o a.png --size 16x16 --voxel --eye 7.5,7.5,7.5 --direction 0,1,0");
    EXPECT_EQ(inside.status, 0);
    EXPECT_THAT(inside.err, AllOf(HasSubstr("the eye"), HasSubstr("is inside opaque matter: voxel 8, 8, 8")));
    EXPECT_THAT(run("render builtin:sphere:16 -o a.png --size 16x16").err, IsEmpty());
}

TEST_F(CliLooks, PrintsManualAndCompletionScripts) {
    const ProgramRun man = run("--man");
    EXPECT_EQ(man.status, 0);
    EXPECT_THAT(man.out,
                AllOf(StartsWith(".TH EDGESPLAT 1"), HasSubstr(".SH \"scene new\""), HasSubstr("\\-\\-max\\-error")));
    EXPECT_EQ(run("--completion csh").status, 2);
    for (const char* shell : {"bash", "zsh", "fish"})
        EXPECT_THAT(run(std::string("--completion ") + shell).out, HasSubstr("sheet-format")) << shell;
    EXPECT_THAT(run("--version").out,
                AllOf(StartsWith("edgesplat 0."), HasSubstr("built with Vulkan"), HasSubstr("GDCM ")));
}

TEST_F(CliLooks, CompletesInBash) {
    const auto completed = [&](const std::string& words, int at) {
        return run_shell("'" EDGESPLAT_PROGRAM "' --completion bash >c && bash -c '. ./c; COMP_WORDS=(" + words +
                         "); COMP_CWORD=" + std::to_string(at) + "; _edgesplat; echo ${COMPREPLY[@]}'")
            .out;
    };
    EXPECT_EQ(completed("edgesplat ren", 1), "render\n");
    EXPECT_EQ(completed("edgesplat render a.nrrd --sheet-f", 3), "--sheet-format\n");
    EXPECT_EQ(completed("edgesplat render a.nrrd --sheet-format t", 4), "tiles\n");
    EXPECT_EQ(completed("edgesplat scene n", 2), "new\n");
    EXPECT_EQ(completed("edgesplat render a.nrrd --output p", 4), "\n") << "the shell completes file names";
}

}  // namespace
}  // namespace edgesplat
