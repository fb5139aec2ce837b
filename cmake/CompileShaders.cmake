# edgesplat_add_shaders(target folder): compiles every folder/*.{comp,vert,frag} to SPIR-V at build time and embeds
# it; C++ finds a shader by its file name through find_shader("3_select_footprints.comp").
function(edgesplat_add_shaders target folder)
    file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.comp ${folder}/*.vert ${folder}/*.frag)
    file(GLOB includes CONFIGURE_DEPENDS ${folder}/shared/*.h ${folder}/lib/*.glsl ${CMAKE_SOURCE_DIR}/shaders/shared/*.h
        ${CMAKE_SOURCE_DIR}/shaders/lib/*.glsl)
    set(out ${CMAKE_CURRENT_BINARY_DIR}/${target}_shaders)
    file(MAKE_DIRECTORY ${out})
    set(headers)
    set(table "")
    foreach(source ${sources})
        get_filename_component(name ${source} NAME)
        string(MAKE_C_IDENTIFIER "spv_${name}" symbol)
        add_custom_command(OUTPUT ${out}/${name}.inc
            COMMAND ${GLSLANG_VALIDATOR} --quiet --target-env vulkan1.3 -I${folder} -I${CMAKE_SOURCE_DIR}/shaders -V
                ${source} --vn ${symbol} -o ${out}/${name}.inc
            DEPENDS ${source} ${includes} VERBATIM)
        list(APPEND headers ${out}/${name}.inc)
        string(APPEND table "#include \"${out}/${name}.inc\"\n")
        string(APPEND entries "    {\"${name}\", ${symbol}},\n")
    endforeach()
    file(CONFIGURE OUTPUT ${out}/${target}_shaders.cpp CONTENT "#include <cstdint>
#include \"engine/gpu/shader.h\"
namespace {
${table}const edgesplat::gpu::EmbeddedShader kShaders[] = {
${entries}};
const bool kRegistered = edgesplat::gpu::register_shaders(kShaders);
}  // namespace
bool edgesplat_${target}_shaders_linked() { return kRegistered; }
" @ONLY)
    set_source_files_properties(${out}/${target}_shaders.cpp PROPERTIES OBJECT_DEPENDS "${headers}")
    target_sources(${target} PRIVATE ${out}/${target}_shaders.cpp)
endfunction()
