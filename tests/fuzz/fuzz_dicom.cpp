// DICOM files: elements, frames, segmentations, and pixels that are native or run-length coded. GDCM, which decodes the
// other transfer syntaxes, is not fuzzed.
#include "engine/error.h"
#include "engine/volume/io/dicom.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = edgesplat::fuzz::text_of(data, size);
    const std::string path = (edgesplat::fuzz::folder() / "volume.dcm").string();
    try {
        const edgesplat::detail::DicomFile file(path, text);
        const std::string& syntax = file.transfer_syntax();
        if (syntax.starts_with("1.2.840.10008.1.2.4.")) {
            (void)edgesplat::detail::read_dicom_image(file);
            return 0;
        }
    } catch (const edgesplat::Error&) {
        return 0;
    }
    edgesplat::fuzz::write("volume.dcm", text);
    for (const bool chosen : {false, true}) {
        edgesplat::LoadOptions options;
        if (chosen) {
            options.component = options.frame = 0;
            options.series = "0";
            options.resample = true;
            options.spacing = glm::dvec3(1);
        }
        try {
            (void)edgesplat::detail::load_dicom(path, {path}, options);
        } catch (const edgesplat::Error&) {
        }
    }
    return 0;
}
