// Runs the navigation app with a script in an empty folder, for the fly_*_test.cpp files.
#pragma once

#include <gmock/gmock.h>

#include "engine/image/image_compare.h"
#include "engine/image/image_file.h"
#include "tests/unit/cli_program.h"

namespace edgesplat {

class FlyTest : public CliTest {
  protected:
    /// Plays the script with validation and expects success; its files are in the folder.
    void fly(const std::string& script, const std::string& arguments = "builtin:torus:32") const {
        const ProgramRun result = try_to_fly(script, arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.err, "");
    }
    ProgramRun try_to_fly(const std::string& script, const std::string& arguments) const {
        std::ofstream(folder_ / "script.txt") << "size 480 320\nquality fixed\n" << script;
        return run_shell("'" EDGESPLAT_FLY "' --headless --no-preferences --validation --script script.txt " +
                         arguments);
    }
    Image image(const std::string& name) const { return read_image(folder_ / name).image; }
};

/// Columns [first, last) of a picture, without its top rows.
inline Image columns(const Image& image, int first, int last, int top = 40) {
    Image out(last - first, image.height - top, image.channels);
    for (int y = 0; y < out.height; ++y)
        for (int x = first; x < last; ++x)
            for (int c = 0; c < image.channels; ++c)
                out.at(x - first, y, c) = image.at(x, y + top, c);
    return out;
}

}  // namespace edgesplat
