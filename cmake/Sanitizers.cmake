# -DEDGESPLAT_SANITIZE=address|undefined|thread; set by the asan and ubsan presets.
if(EDGESPLAT_SANITIZE)
    add_compile_options(-fsanitize=${EDGESPLAT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    add_link_options(-fsanitize=${EDGESPLAT_SANITIZE})
endif()
