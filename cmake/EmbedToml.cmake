# edgesplat_embed_toml(TARGET FOLDER HEADER NAMESPACE TYPE FUNCTION): embeds every FOLDER/*.toml in the library, so that
# programs need no installed files. FUNCTION, declared in HEADER, returns them as a span of TYPE{name, text}.
function(edgesplat_embed_toml target folder header namespace type function)
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
    get_filename_component(from ${folder} NAME)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT [=[
// Generated from @from@/*.toml.
#include "@header@"

#include <array>

namespace @namespace@ {
namespace {
constexpr std::array<@type@, @count@> kFiles{{
@entries@}};
}  // namespace
std::span<const @type@> @function@() {
    return kFiles;
}
}  // namespace @namespace@
]=] @ONLY)
    target_sources(${target} PRIVATE ${source})
endfunction()
