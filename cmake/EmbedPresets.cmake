# edgesplat_embed_presets(TARGET FOLDER): puts every FOLDER/*.toml into the library, as `edgesplat::embedded_presets()`
# (engine/scene/scene_presets.cpp), so that programs find them wherever they are installed.
function(edgesplat_embed_presets target folder)
    file(GLOB files CONFIGURE_DEPENDS ${folder}/*.toml)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${files})
    set(entries "")
    set(count 0)
    foreach(file IN LISTS files)
        get_filename_component(name ${file} NAME_WE)
        file(READ ${file} text)
        string(APPEND entries "    {\"${name}\", R\"toml(${text})toml\"},\n")
        math(EXPR count "${count} + 1")
    endforeach()
    set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded_presets.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT [=[
// Made from presets/*.toml.
#include "engine/scene/embedded_presets.h"

#include <array>

namespace edgesplat {
namespace {
constexpr std::array<EmbeddedPreset, @count@> kPresets{{
@entries@}};
}  // namespace
std::span<const EmbeddedPreset> embedded_presets() {
    return kPresets;
}
}  // namespace edgesplat
]=] @ONLY)
    target_sources(${target} PRIVATE ${source})
endfunction()
