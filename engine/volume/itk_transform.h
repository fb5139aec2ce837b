// Results of registrations: linear transforms in the files of ITK, which Slicer, ANTs and elastix write.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>

namespace edgesplat {

/// Reads a rigid or affine transform from a text file (.tfm, .txt), HDF5 (.h5, .hdf5) or MATLAB (.mat of ANTs). Result:
/// the matrix that maps points of the fixed image to the moving one, patient LPS, mm; its inverse places the moving
/// image. Throws Error naming file and field, also for transforms that bend.
glm::dmat4 read_itk_transform(const std::filesystem::path& path);

}  // namespace edgesplat
