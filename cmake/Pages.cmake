# Manual pages and shell completions. The programs generate them; they are installed where man and shells find them.
set(pages)
foreach(program edgesplat edgesplat-fly)
    set(folder ${CMAKE_BINARY_DIR}/pages/${program})
    file(MAKE_DIRECTORY ${folder})
    set(files ${folder}/${program}.1.gz ${folder}/${program} ${folder}/_${program} ${folder}/${program}.fish)
    add_custom_command(OUTPUT ${files} DEPENDS ${program} COMMENT "Pages of ${program}" VERBATIM
        COMMAND $<TARGET_FILE:${program}> --man > ${folder}/${program}.1
        COMMAND gzip -9nf ${folder}/${program}.1
        COMMAND $<TARGET_FILE:${program}> --completion bash > ${folder}/${program}
        COMMAND $<TARGET_FILE:${program}> --completion zsh > ${folder}/_${program}
        COMMAND $<TARGET_FILE:${program}> --completion fish > ${folder}/${program}.fish)
    list(APPEND pages ${files})
    install(FILES ${folder}/${program}.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${program})
    install(FILES ${folder}/${program} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        COMPONENT ${program})
    install(FILES ${folder}/_${program} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions
        COMPONENT ${program})
    install(FILES ${folder}/${program}.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
        COMPONENT ${program})
endforeach()
add_custom_target(edgesplat_page_files ALL DEPENDS ${pages})
