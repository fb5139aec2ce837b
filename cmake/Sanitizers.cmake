# -DEDGESPLAT_SANITIZE=address|undefined|thread, or two of them with a comma; set by the asan, ubsan and tsan presets.
if(EDGESPLAT_SANITIZE)
    add_compile_options(-fsanitize=${EDGESPLAT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    # Sanitizers stand between dlopen and its caller, whose run path is then not asked: only that of the old kind is.
    add_link_options(-fsanitize=${EDGESPLAT_SANITIZE} LINKER:--disable-new-dtags)
endif()
