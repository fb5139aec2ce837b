# Install rules and the package for find_package(edgesplat): edgesplat::engine and the libraries below it.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/edgesplat)

foreach(library footprints volume scene reference engine)
    set_target_properties(edgesplat_${library} PROPERTIES EXPORT_NAME ${library})
    install(TARGETS edgesplat_${library} EXPORT edgesplatTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        COMPONENT dev)
endforeach()
install(TARGETS edgesplat_pictures edgesplat_codecs LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/edgesplat
    COMPONENT edgesplat)
install(EXPORT edgesplatTargets NAMESPACE edgesplat:: DESTINATION ${package_folder} COMPONENT dev)

# Public headers. Headers that only the library's own sources include are not installed.
install(DIRECTORY ${CMAKE_SOURCE_DIR}/engine ${CMAKE_SOURCE_DIR}/footprints
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/edgesplat COMPONENT dev FILES_MATCHING PATTERN "*.h"
    PATTERN gpu EXCLUDE PATTERN passes EXCLUDE PATTERN accuracy EXCLUDE PATTERN bench EXCLUDE PATTERN renderer EXCLUDE
    PATTERN frame EXCLUDE PATTERN plan EXCLUDE PATTERN store EXCLUDE PATTERN culling EXCLUDE
    PATTERN raycast EXCLUDE PATTERN "parts.h" EXCLUDE PATTERN "description*.h" EXCLUDE PATTERN "forecast.h" EXCLUDE
    PATTERN "memory.h" EXCLUDE PATTERN "effect_rows.h" EXCLUDE PATTERN "*_internal.h" EXCLUDE
    PATTERN io EXCLUDE PATTERN "scene_table.h" EXCLUDE)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/CHANGELOG.md
    DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT edgesplat)

configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/edgesplatConfig.cmake.in
    ${CMAKE_BINARY_DIR}/edgesplatConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/edgesplatConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/edgesplatConfig.cmake ${CMAKE_BINARY_DIR}/edgesplatConfigVersion.cmake
    DESTINATION ${package_folder} COMPONENT dev)

# Builds a separate program against an installed copy. Skipped for sanitized libraries, which need sanitized programs.
if(EDGESPLAT_TESTS AND NOT EDGESPLAT_SANITIZE)
    add_test(NAME package.embed COMMAND ${CMAKE_COMMAND} -DBUILD=${CMAKE_BINARY_DIR} -DSOURCE=${CMAKE_SOURCE_DIR}
        -DGENERATOR=${CMAKE_GENERATOR} -DCONFIG=$<CONFIG> -P ${CMAKE_SOURCE_DIR}/tests/package/embed.cmake)
    set_tests_properties(package.embed PROPERTIES LABELS package TIMEOUT 600)
endif()

include(Debian)
