# edgesplat_add_shaders(target folder): compiles every folder/*/*.{comp,vert,frag} to SPIR-V in the build tree and embeds
# it in `target`. C++ finds a shader by its file name: gpu::find_shader("3_select_footprints.comp").
function(edgesplat_add_shaders target folder)
    file(GLOB sources CONFIGURE_DEPENDS ${folder}/*/*.comp ${folder}/*/*.vert ${folder}/*/*.frag)
    file(GLOB includes CONFIGURE_DEPENDS ${folder}/*/*.h ${folder}/*/*.glsl 
        ${CMAKE_SOURCE_DIR}/footprints/*.glsl ${CMAKE_SOURCE_DIR}/engine/geometry/*.glsl)
    set(out ${CMAKE_CURRENT_BINARY_DIR}/${target}_shaders)
    file(MAKE_DIRECTORY ${out})
    foreach(source ${sources})
        get_filename_component(name ${source} NAME)
        string(MAKE_C_IDENTIFIER "spirv_${name}" symbol)
        add_custom_command(OUTPUT ${out}/${name}.inc
            COMMAND ${GLSLANG_VALIDATOR} --quiet --target-env vulkan1.3 -I${CMAKE_SOURCE_DIR} -V ${source}
                --vn ${symbol} -o ${out}/${name}.inc
            DEPENDS ${source} ${includes} VERBATIM)
        list(APPEND headers ${out}/${name}.inc)
        string(APPEND table "#include \"${out}/${name}.inc\"\n")
        string(APPEND entries "    {\"${name}\", ${symbol}},\n")
    endforeach()
    file(CONFIGURE OUTPUT ${out}/embedded_shaders.cpp CONTENT "#include <cstdint>

#include \"engine/gpu/shader.h\"
namespace {
${table}}  // namespace
namespace edgesplat::gpu {
static const EmbeddedShader kShaders[] = {
${entries}};
std::span<const EmbeddedShader> embedded_shaders() { return kShaders; }
}  // namespace edgesplat::gpu
" @ONLY)
    set_source_files_properties(${out}/embedded_shaders.cpp PROPERTIES OBJECT_DEPENDS "${headers}"
        SKIP_UNITY_BUILD_INCLUSION ON)
    target_sources(${target} PRIVATE ${out}/embedded_shaders.cpp)
endfunction()
