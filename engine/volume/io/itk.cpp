// Reads one file through an ITK ImageIO, without ITK's pixel-type templates and factories: the ImageIO reads header and
// data, and the voxels are converted to float here.
#include <itkVTKImageIO.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "engine/volume/io/itk.h"
#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

const char* name_of(ItkFormat format) {
    switch (format) {
        case ItkFormat::Vtk:
            return "legacy VTK image data";
    }
    return "";
}

itk::ImageIOBase::Pointer image_io(ItkFormat format) {
    switch (format) {
        case ItkFormat::Vtk:
            return itk::VTKImageIO::New().GetPointer();
    }
    return {};
}

// Calls ITK and captures its output. Some ImageIOs print an error and continue: with `strict`, any output is an error.
template <typename Call>
void guarded(const ItkRequest& request, bool strict, Call&& call) {
    std::string reason, chatter;
    {
        OutputCapture capture;
        try {
            call();
        } catch (const itk::ExceptionObject& error) {
            reason = error.GetDescription();
            if (reason.empty()) reason = error.what();
        } catch (const std::bad_alloc&) {
            reason = "not enough memory";
        } catch (const std::exception& error) {
            reason = error.what();
        }
        chatter = capture.text();
    }
    if (reason.empty() && strict) reason = chatter;
    auto text = tidy(reason);
    if (text.empty()) return;
    if (reason != chatter && !tidy(chatter).empty()) text += " (" + tidy(chatter) + ")";
    // The user does not know the temporary files.
    if (!request.read_path.empty() && request.read_path != request.path)
        for (auto at = text.find(request.read_path); at != std::string::npos; at = text.find(request.read_path))
            text.replace(at, request.read_path.size(), "the file");
    fail("{}: cannot be read as {}: {}", request.path, name_of(request.format), text);
}

}  // namespace

SampleType sample_type_of(const itk::ImageIOBase& io, const std::string& path) {
    using Type = itk::IOComponentEnum;
    switch (io.GetComponentType()) {
        case Type::CHAR:
            return SampleType::Int8;
        case Type::UCHAR:
            return SampleType::UInt8;
        case Type::SHORT:
            return SampleType::Int16;
        case Type::USHORT:
            return SampleType::UInt16;
        case Type::INT:
            return SampleType::Int32;
        case Type::UINT:
            return SampleType::UInt32;
        case Type::LONG:
            return sizeof(long) == 8 ? SampleType::Int64 : SampleType::Int32;
        case Type::ULONG:
            return sizeof(long) == 8 ? SampleType::UInt64 : SampleType::UInt32;
        case Type::LONGLONG:
            return SampleType::Int64;
        case Type::ULONGLONG:
            return SampleType::UInt64;
        case Type::FLOAT:
            return SampleType::Float32;
        case Type::DOUBLE:
            return SampleType::Float64;
        default:
            fail("{}: voxels of a type that cannot be read ({})", path,
                 itk::ImageIOBase::GetComponentTypeAsString(io.GetComponentType()));
    }
}

std::vector<std::size_t> dims_of(const itk::ImageIOBase& io) {
    std::vector<std::size_t> dims(io.GetNumberOfDimensions());
    for (unsigned axis = 0; axis < dims.size(); ++axis)
        dims[axis] = io.GetDimensions(axis);
    return dims;
}

void set_full_region(itk::ImageIOBase& io) {
    itk::ImageIORegion region(io.GetNumberOfDimensions());
    for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis) {
        region.SetIndex(axis, 0);
        region.SetSize(axis, io.GetDimensions(axis));
    }
    io.SetIORegion(region);
}

VolumeGeometry geometry_of(const itk::ImageIOBase& io) {
    VolumeGeometry geometry;
    geometry.dims = glm::ivec3(1);
    const unsigned axes = std::min(io.GetNumberOfDimensions(), 3U);
    for (unsigned axis = 0; axis < axes; ++axis) {
        const auto direction = io.GetDirection(axis);
        const int column = static_cast<int>(axis);
        geometry.dims[column] = static_cast<int>(io.GetDimensions(axis));
        geometry.origin[column] = io.GetOrigin(axis) + 0.0;
        for (unsigned row = 0; row < 3; ++row)
            geometry.index_to_world_axes[column][static_cast<int>(row)] =
                (row < axes ? direction[row] * io.GetSpacing(axis) : 0.0) + 0.0;  // + 0: no negative zeros
    }
    return geometry;
}

}

/// An ImageIO that has read the file's header.
static itk::ImageIOBase::Pointer header_of(const ItkRequest& request) {
    auto io = image_io(request.format);
    guarded(request, false, [&] {
        io->SetFileName(request.read_path.empty() ? request.path : request.read_path);
        io->ReadImageInformation();
    });
    return io;
}

Volume load_through_itk(const ItkRequest& request, const LoadOptions& options) {
    const std::string& path = request.path;
    report(options, 0.0, "reading header");
    const auto io = header_of(request);
    auto dims = dims_of(*io);
    while (dims.size() > 3 && dims.back() == 1)
        dims.pop_back();
    if (dims.size() < 2) fail("{}: its data have 1 axis; a volume needs 3, or 2 for a single slice", path);

    Volume volume;
    volume.name = path;
    const auto type = sample_type_of(*io, path);
    volume.stored_type = request.stored_type.empty() ? std::string(name_of(type)) : request.stored_type;
    const std::size_t components = io->GetNumberOfComponents();
    const std::size_t needed = checked_bytes(path, dims, components * size_of(type));
    if (request.stored_bytes > 0) check_stored_size(path, needed, request.stored_bytes, request.stored_ratio);
    if (request.check_data) request.check_data(needed, needed / size_of(type));
    const std::size_t component = chosen_component(path, options, components);
    std::size_t frames = 1;
    for (std::size_t axis = 3; axis < dims.size(); ++axis)
        frames *= dims[axis];
    const std::size_t frame = chosen_frame(path, options, frames);
    volume.geometry = geometry_of(*io);
    if (dims.size() == 2)
        volume.notes.push_back("The file holds a 2-D image: it is read as a volume of one slice, 1 mm thick.");

    try {
        volume.values.resize(volume.geometry.voxel_count());
        set_full_region(*io);
        report(options, 0.05, "reading voxels");
        const bool direct = type == SampleType::Float32 && components == 1 && frames == 1;
        if (direct) {
            guarded(request, true, [&] { io->Read(volume.values.data()); });
        } else {
            const auto buffer = std::make_unique<std::byte[]>(needed);
            guarded(request, true, [&] { io->Read(buffer.get()); });
            report(options, 0.7, "converting voxels");
            const std::size_t first = frame * volume.values.size() * components + component;
            convert_samples(type, buffer.get(), first, components, volume.values.size(), volume.values.data());
        }
    } catch (const std::bad_alloc&) {
        fail("{}: not enough memory for {} voxels", path, volume.geometry.voxel_count());
    }
    return volume;
}

}  // namespace edgesplat::detail
