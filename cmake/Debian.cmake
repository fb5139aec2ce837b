# Packages for Debian and Ubuntu: cpack -G DEB in a build folder (./dev package).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME edgesplat)
set(CPACK_PACKAGE_VENDOR "Edgesplat developers")
# The maintainer is the person who builds the package: DEBFULLNAME and DEBEMAIL (Debian's convention), otherwise git's
# user, otherwise the author of the last commit.
foreach(row "DEBFULLNAME user.name %an packer" "DEBEMAIL user.email %ae packer_mail")
    string(REPLACE " " ";" row ${row})
    list(GET row 0 variable)
    list(GET row 1 key)
    list(GET row 2 author)
    list(GET row 3 result)
    set(${result} $ENV{${variable}})
    foreach(arguments "config;${key}" "log;-1;--format=${author}")
        if(NOT ${result})
            execute_process(COMMAND git -C ${CMAKE_SOURCE_DIR} ${arguments} OUTPUT_VARIABLE ${result}
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
        endif()
    endforeach()
endforeach()
set(CPACK_PACKAGE_CONTACT "${packer} <${packer_mail}>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_COMPONENTS_ALL edgesplat edgesplat-fly dev)
if(EDGESPLAT_PYTHON)
    list(APPEND CPACK_COMPONENTS_ALL python-debian)
endif()

# edgesplat_deb(COMPONENT PACKAGE SUMMARY DESCRIPTION DEPENDS): fields of the control file. Each line of DESCRIPTION is a
# paragraph.
function(edgesplat_deb component package summary description depends)
    string(TOUPPER ${component} upper)
    set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package} PARENT_SCOPE)
    set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${description}" PARENT_SCOPE)
    set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}" PARENT_SCOPE)
    # Copyright and changelog, which every package must install in its own documentation folder.
    set(doc ${CMAKE_INSTALL_DATADIR}/doc/${package})
    install(FILES ${CMAKE_SOURCE_DIR}/packaging/copyright DESTINATION ${doc} COMPONENT ${component} EXCLUDE_FROM_ALL)
    install(FILES ${CMAKE_BINARY_DIR}/packaging/changelog.gz DESTINATION ${doc} COMPONENT ${component} EXCLUDE_FROM_ALL)
endfunction()
edgesplat_deb(edgesplat edgesplat "volume renderer by splatting that keeps edges sharp"
    "Renders scalar volumes (CT, MRI, simulation, segmentations) to pictures\nand movies with Vulkan, and keeps edges sharp when the eye comes close."
    "")
edgesplat_deb(edgesplat-fly edgesplat-fly "fly through volumes with sharp edges"
    "Shows scalar volumes (CT, MRI, simulation, segmentations) from outside\nlike a model and from inside like an endoscope."
    "edgesplat (= ${PROJECT_VERSION})")
edgesplat_deb(dev libedgesplat-dev "volume renderer by splatting, for programs"
    "Static libraries, headers and the CMake package edgesplat::engine."
    "edgesplat (= ${PROJECT_VERSION}), cmake, libvulkan-dev, libglm-dev, libfmt-dev, libpng-dev, libhdf5-dev, libnetcdf-dev, libbz2-dev, libarchive-dev, libpugixml-dev, liblz4-dev, liblzma-dev, zlib1g-dev, libtomlplusplus-dev, pkgconf")
edgesplat_deb(python-debian python3-edgesplat "volume renderer by splatting, for Python"
    "The module edgesplat: arrays, files and scenes in, pictures as arrays out."
    "python3, python3-numpy, edgesplat (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_EDGESPLAT_PACKAGE_RECOMMENDS "mesa-vulkan-drivers, fonts-dejavu-core")
set(CPACK_DEBIAN_EDGESPLAT_PACKAGE_SUGGESTS "ffmpeg, gnuplot-nox")
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_PYTHON-DEBIAN_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON-DEBIAN_PACKAGE_SUGGESTS "python3-ipywidgets")

# Debian's changelog needs a date: that of the commit.
execute_process(COMMAND git -C ${CMAKE_SOURCE_DIR} log -1 --format=%cD OUTPUT_VARIABLE date
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR NOT date)
    string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
endif()
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/packaging/changelog CONTENT [=[
edgesplat (@PROJECT_VERSION@) unstable; urgency=medium

  * CHANGELOG.md, in the package edgesplat, lists the changes.

 -- @CPACK_PACKAGE_CONTACT@  @date@
]=] @ONLY)
execute_process(COMMAND gzip -9nkf ${CMAKE_BINARY_DIR}/packaging/changelog)
include(CPack)
