// Reads VTK's XML image data through VTK, if the build has it.
#include "engine/volume/io/readers.h"

#ifdef EDGESPLAT_HAS_VTK
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLImageDataReader.h>
#endif

namespace edgesplat {

bool can_read_vti() {
#ifdef EDGESPLAT_HAS_VTK
    return true;
#else
    return false;
#endif
}

}  // namespace edgesplat

namespace edgesplat::detail {

#ifndef EDGESPLAT_HAS_VTK

Volume load_vti(const std::string& path, const LoadOptions&) {
    fail(
        "{}: a VTK XML file; this build cannot read .vti. Build with -DEDGESPLAT_VTK=ON (Debian: libvtk9-dev), or "
        "convert "
        "the file to .mhd or .nrrd, e.g. with ParaView",
        path);
}

#else

namespace {

SampleType sample_type_of(const std::string& path, vtkDataArray& array) {
    const bool is_signed = array.GetDataTypeMin() < 0;
    const int size = array.GetDataTypeSize();
    if (array.GetDataType() == VTK_FLOAT) return SampleType::Float32;
    if (array.GetDataType() == VTK_DOUBLE) return SampleType::Float64;
    if (size == 1) return is_signed ? SampleType::Int8 : SampleType::UInt8;
    if (size == 2) return is_signed ? SampleType::Int16 : SampleType::UInt16;
    if (size == 4) return is_signed ? SampleType::Int32 : SampleType::UInt32;
    if (size == 8) return is_signed ? SampleType::Int64 : SampleType::UInt64;
    fail("{}: samples of type {} cannot be read", path, array.GetDataTypeAsString());
}

}  // namespace

Volume load_vti(const std::string& path, const LoadOptions& options) {
    const vtkNew<vtkXMLImageDataReader> reader;
    std::string chatter;
    report(options, 0.0, "reading header");
    bool readable = false;
    {
        OutputCapture capture;
        readable = reader->CanReadFile(path.c_str()) != 0;
        if (readable) {
            reader->SetFileName(path.c_str());
            reader->UpdateInformation();
        }
        chatter = capture.text();
    }
    if (!readable) fail("{}: a VTK XML file, but not image data: {}", path, tidy(chatter));
    if (chatter.find("rror") != std::string::npos) fail("{}: truncated or damaged: {}", path, tidy(chatter));
    int extent[6] = {0, -1, 0, -1, 0, -1};
    reader->GetOutputInformation(0)->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
    std::vector<std::size_t> dims;
    for (int axis = 0; axis < 3; ++axis) {
        const long long n = static_cast<long long>(extent[2 * axis + 1]) - extent[2 * axis] + 1;
        if (n < 1)
            fail("{}: WholeExtent {} {} of axis {} is empty", path, extent[2 * axis], extent[2 * axis + 1], axis);
        dims.push_back(static_cast<std::size_t>(n));
    }
    check_stored_size(path, checked_bytes(path, dims, 1), std::filesystem::file_size(path));
    report(options, 0.05, "reading voxels");
    {
        OutputCapture capture;
        reader->Update();
        chatter = capture.text();
    }
    vtkImageData* image = reader->GetOutput();
    if (reader->GetErrorCode() != 0 || chatter.find("ERR") != std::string::npos ||
        chatter.find("rror") != std::string::npos)
        fail("{}: VTK cannot read it: {}", path, chatter.empty() ? "truncated or damaged" : tidy(chatter));
    vtkDataArray* array = image->GetPointData()->GetScalars();
    Volume volume;
    if (array == nullptr && image->GetPointData()->GetNumberOfArrays() > 0) {
        array = image->GetPointData()->GetArray(0);
        if (array != nullptr)
            volume.notes.push_back(fmt::format("No array is marked as scalars: '{}' was used.", array->GetName()));
    }
    if (array == nullptr)
        fail("{}: no values at its points ({} arrays of cells)", path, image->GetCellData()->GetNumberOfArrays());
    const std::size_t voxels = dims[0] * dims[1] * dims[2];
    // cppcheck-suppress nullPointerRedundantCheck; fail() does not return
    if (static_cast<std::size_t>(array->GetNumberOfTuples()) != voxels)
        fail("{}: {} values for {} voxels: truncated or damaged", path, array->GetNumberOfTuples(), voxels);
    const auto components = static_cast<std::size_t>(array->GetNumberOfComponents());
    const auto component = chosen_component(path, options, components);
    (void)chosen_frame(path, options, 1);
    const auto type = sample_type_of(path, *array);
    volume.name = path;
    volume.stored_type = name_of(type);
    volume.geometry.dims = glm::ivec3(dims[0], dims[1], dims[2]);
    const vtkMatrix3x3* direction = image->GetDirectionMatrix();
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            volume.geometry.index_to_world_axes[column][row] =
                direction->GetElement(row, column) * image->GetSpacing()[column] + 0.0;
    const double* origin = image->GetOrigin();
    const glm::dvec3 corner(extent[0], extent[2],
                            extent[4]);  // VTK's origin belongs to index 0, also if the extent begins elsewhere
    volume.geometry.origin = glm::dvec3(origin[0], origin[1], origin[2]) + volume.geometry.index_to_world_axes * corner;
    volume.values.resize(voxels);
    report(options, 0.7, "converting voxels");
    convert_samples(type, array->GetVoidPointer(0), component, components, voxels, volume.values.data());
    return volume;
}

#endif

}  // namespace edgesplat::detail
