# Warnings of all own targets; third-party headers are SYSTEM and exempt. Warnings are errors only if
# CMAKE_COMPILE_WARNING_AS_ERROR is set, as ./dev does: a newer compiler may add warnings after a release.
add_library(edgesplat_warnings INTERFACE)
target_compile_options(edgesplat_warnings INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-qual -Woverloaded-virtual
    -Wdouble-promotion -Wimplicit-fallthrough
    -Wno-missing-field-initializers)  # designated initialisers leave members at their defaults on purpose
# GCC 12 reports false positives for std::string and std::vector under -O2 and sanitizers.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(edgesplat_warnings INTERFACE -Wno-restrict -Wno-maybe-uninitialized -Wno-array-bounds
        -Wno-stringop-overflow)
endif()
