# Run at every build: writes the commit that is built into OUTPUT, and only where it is another than before.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=10 --exclude=* OUTPUT_VARIABLE commit
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
    set(commit "")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [=[
// Made by cmake/Commit.cmake.
#include "apps/version.h"

std::string_view built_commit() {
    return "@commit@";
}
]=] @ONLY)
