# All third-party libraries, from the distribution's packages (cmake/packages.debian).
find_package(Threads REQUIRED)
find_package(Vulkan REQUIRED)
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PkgConfig REQUIRED)
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)

# Pictures: libpng for PNG, OpenImageIO for all other formats.
find_package(PNG REQUIRED)
# OpenImageIO's CMake package on Debian 12 requires programs that its -dev package does not contain; pkg-config works.
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)

# TIFF and OME-Zarr: libtiff and the codecs are in a module, the headers are read by these two.
find_package(TIFF REQUIRED)
pkg_check_modules(BLOSC REQUIRED IMPORTED_TARGET blosc)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
find_package(pugixml REQUIRED)

# Scene files.
pkg_check_modules(TOMLPLUSPLUS REQUIRED IMPORTED_TARGET tomlplusplus)

# What reads files of volumes, for edgesplat_volume.
add_library(edgesplat_formats INTERFACE)

# Compressed pixels of DICOM files.
find_package(GDCM REQUIRED)

# Packed volumes and HDF5 files.
find_package(HDF5 REQUIRED COMPONENTS C)
# netCDF files.
pkg_check_modules(NETCDF REQUIRED IMPORTED_TARGET netcdf)

# bzip2 in NRRD; gzip in NIfTI, MGH and MRC.
find_package(ZLIB REQUIRED)
find_package(BZip2 REQUIRED)
target_link_libraries(edgesplat_formats INTERFACE ZLIB::ZLIB BZip2::BZip2)
# Series in zip archives.
find_package(LibArchive REQUIRED)
# VTK's XML files: the document, and blocks compressed by LZ4 and LZMA.
find_package(pugixml REQUIRED)
find_package(LibLZMA REQUIRED)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
target_link_libraries(edgesplat_formats INTERFACE pugixml::pugixml LibLZMA::LibLZMA PkgConfig::LZ4)

# The navigation app: window and widgets. Debian's imgui library contains the Vulkan backend.
find_package(glfw3 3.3 REQUIRED)
pkg_check_modules(IMGUI REQUIRED imgui)
find_library(IMGUI_LIBRARY imgui HINTS ${IMGUI_LIBRARY_DIRS} REQUIRED)
# The backend calls Vulkan, which imgui's pkg-config file omits; Vulkan must follow imgui in the link order.
add_library(edgesplat_imgui UNKNOWN IMPORTED)
set_target_properties(edgesplat_imgui PROPERTIES IMPORTED_LOCATION ${IMGUI_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES "${IMGUI_INCLUDE_DIRS}" INTERFACE_LINK_LIBRARIES "stb;Vulkan::Vulkan")

# MPI divides a movie's frames among many processes; only the program edgesplat uses it.
find_package(MPI QUIET COMPONENTS C)
option(EDGESPLAT_MPI "Divide a movie's frames among the processes of mpirun" ${MPI_C_FOUND})
if(EDGESPLAT_MPI)
    find_package(MPI REQUIRED COMPONENTS C)
endif()

if(EDGESPLAT_TESTS)
    find_package(GTest REQUIRED)
    # Tests write volumes and transforms through ITK. Named components: otherwise ITK loads every module of its build. Its use file
    # registers factories per directory; an interface target holds its settings instead.
    find_package(ITK REQUIRED COMPONENTS ITKCommon ITKIOImageBase ITKIONRRD ITKIOMeta ITKIONIFTI ITKIOVTK ITKIOGIPL
        ITKTransform ITKIOTransformBase ITKIOTransformInsightLegacy ITKIOTransformHDF5 ITKIOTransformMatlab)
    add_library(edgesplat_itk INTERFACE)
    target_include_directories(edgesplat_itk SYSTEM INTERFACE ${ITK_INCLUDE_DIRS})
    target_link_libraries(edgesplat_itk INTERFACE ${ITK_LIBRARIES})
endif()
