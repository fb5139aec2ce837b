# edgesplat_embed_toml(TARGET FOLDER HEADER NAMESPACE TYPE FUNCTION): puts every FOLDER/*.toml into the library, as what
# the function FUNCTION of HEADER returns: a span of TYPE{name, text}. Programs find them wherever they are installed.
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
// Made from @from@/*.toml.
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
