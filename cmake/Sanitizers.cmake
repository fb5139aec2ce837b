# -DEDGESPLAT_SANITIZE=address|undefined|thread, or two of them, comma-separated. The presets asan, ubsan and tsan set it.
if(EDGESPLAT_SANITIZE)
    add_compile_options(-fsanitize=${EDGESPLAT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    # Sanitizers intercept dlopen, which then ignores the caller's DT_RUNPATH; it still reads the older DT_RPATH.
    add_link_options(-fsanitize=${EDGESPLAT_SANITIZE} LINKER:--disable-new-dtags)
endif()
