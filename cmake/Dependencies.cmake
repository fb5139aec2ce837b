# Everything third-party, from the distribution's packages (cmake/packages.debian).
find_package(Threads REQUIRED)
find_package(Vulkan REQUIRED)
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PkgConfig REQUIRED)
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)

# Pictures: PNG, and for everything else OpenImageIO.
find_package(PNG REQUIRED)
# OpenImageIO's CMake package on Debian 12 asks for programs its -dev package does not bring; pkg-config works.
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)

# Scene files.
pkg_check_modules(TOMLPLUSPLUS REQUIRED IMPORTED_TARGET tomlplusplus)

# Components by name: without them ITK loads every module it was built with.
set(EDGESPLAT_ITK_COMPONENTS ITKCommon ITKIOImageBase ITKIONRRD ITKIOMeta ITKIONIFTI ITKIOGDCM ITKIOVTK
    ITKIOMINC ITKIOGIPL ITKImageFunction ITKImageGrid)
find_package(ITK REQUIRED COMPONENTS ${EDGESPLAT_ITK_COMPONENTS})
# ITK's own use file registers factories per directory; what it sets is kept in one interface target.
add_library(edgesplat_itk INTERFACE)
target_include_directories(edgesplat_itk SYSTEM INTERFACE ${ITK_INCLUDE_DIRS})
target_link_libraries(edgesplat_itk INTERFACE ${ITK_LIBRARIES})

# Packed volumes. A module of CMake's that ITK's own search has already been through.
find_package(HDF5 REQUIRED COMPONENTS C)

# What ITK's readers lack: bzip2 in NRRD, and a look into (gzipped) NIfTI files before ITK has them.
find_package(ZLIB REQUIRED)
find_package(BZip2 REQUIRED)
target_link_libraries(edgesplat_itk INTERFACE ZLIB::ZLIB BZip2::BZip2)
# Series in zip archives.
find_package(LibArchive REQUIRED)
if(EDGESPLAT_VTK)
    find_package(VTK REQUIRED COMPONENTS IOXML CommonDataModel CommonExecutionModel)
    target_link_libraries(edgesplat_itk INTERFACE VTK::IOXML VTK::CommonDataModel VTK::CommonExecutionModel)
    target_compile_definitions(edgesplat_itk INTERFACE EDGESPLAT_HAS_VTK)
endif()

# The navigation app: window and widgets. Debian's imgui has its Vulkan backend in the library.
find_package(glfw3 3.3 REQUIRED)
pkg_check_modules(IMGUI REQUIRED imgui)
find_library(IMGUI_LIBRARY imgui HINTS ${IMGUI_LIBRARY_DIRS} REQUIRED)
# What its pkg-config file leaves out: the backend in it calls Vulkan, which a linker has to see after it.
add_library(edgesplat_imgui UNKNOWN IMPORTED)
set_target_properties(edgesplat_imgui PROPERTIES IMPORTED_LOCATION ${IMGUI_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES "${IMGUI_INCLUDE_DIRS}" INTERFACE_LINK_LIBRARIES "stb;Vulkan::Vulkan")

# One picture by many processes; only the program edgesplat knows of it.
find_package(MPI QUIET COMPONENTS C)
option(EDGESPLAT_MPI "Divide pictures among the processes of mpirun" ${MPI_C_FOUND})
if(EDGESPLAT_MPI)
    find_package(MPI REQUIRED COMPONENTS C)
endif()

if(EDGESPLAT_TESTS)
    find_package(GTest REQUIRED)
endif()
