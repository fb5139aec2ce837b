// Names files that no reader reads, by their first bytes or their names, and says what to do with them.
#include <algorithm>
#include <array>
#include <cctype>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

struct ForeignSignature {
    std::size_t offset = 0;
    std::string_view bytes;
    std::string_view what;
};

// Content that is no volume under any name.
constexpr std::array kForeignAlways{
    ForeignSignature{0, "version https://git-lfs.github.com/spec/",
                     "a pointer of Git LFS, not the data; fetch them with: git lfs pull"},
    ForeignSignature{0, "/annex/objects/", "a pointer of git-annex, not the data; fetch them with: git annex get"},
    ForeignSignature{0, "%PDF-", "a PDF document"},
    ForeignSignature{0, "7z\xbc\xaf\x27\x1c", "a 7z archive; unpack it with: 7z x"},
    ForeignSignature{0, "Rar!\x1a\x07", "a RAR archive; unpack it with: unrar x"},
    ForeignSignature{0, "# AmiraMesh", "an Amira file; save it as NRRD in Amira or Avizo"},
    ForeignSignature{0, "# Avizo", "an Avizo file; save it as NRRD in Amira or Avizo"},
    ForeignSignature{0, "# HyperMesh", "an Amira file; save it as NRRD in Amira or Avizo"},
    ForeignSignature{0, "# HyperSurface", "a surface of Amira; expected a volume"},
    ForeignSignature{0, std::string_view(" BDV\0\0\0\0", 8),
                     "OpenVDB grids; save the dense samples as .npy (pyopenvdb: copyToArray)"},
    ForeignSignature{0, "ZISRAWFILE", "a Zeiss CZI image; save it as OME-TIFF, e.g. with bfconvert or Fiji"},
    ForeignSignature{0, "\xda\xce\xbe\x0a", "a Nikon ND2 image; save it as OME-TIFF, e.g. with bfconvert or Fiji"},
    ForeignSignature{0, "mrtrix image", "an MRtrix image; convert it with: mrconvert IN.mif OUT.nii"},
    ForeignSignature{0, "!INTERFILE", "an Interfile header; convert it to NIfTI or NRRD, e.g. with (X)MedCon"},
    ForeignSignature{0, "MATRIX7", "an ECAT image; convert it to NIfTI, e.g. with nibabel"},
    ForeignSignature{0, "# === DATA DESCRIPTION FILE", "a Philips PAR header; convert it with: dcm2niix or parrec2nii"},
    ForeignSignature{0, "##TITLE=", "parameters of Bruker ParaVision or JCAMP-DX; convert the study with: dcm2niix"},
    ForeignSignature{0, "DDS v3", "a PVM volume of V^3; convert it to raw data with its pvm2raw"},
    ForeignSignature{0, "PVM", "a PVM volume of V^3; convert it to raw data with its pvm2raw"},
    ForeignSignature{0, "VOL\x03", "a grid of Mitsuba; save it as .npy or NRRD"},
    ForeignSignature{0, "ply\n", "a surface (PLY); expected a volume"},
    ForeignSignature{0, "ply\r", "a surface (PLY); expected a volume"},
    ForeignSignature{0, "OFF\n", "a surface (OFF); expected a volume"},
    ForeignSignature{0, "glTF", "a surface (glTF); expected a volume"},
    ForeignSignature{0, "Kaydara FBX", "a surface (FBX); expected a volume"},
    ForeignSignature{0,
                     "\xff\xff\xfe"
                     "created by",
                     "a surface of FreeSurfer; expected a volume such as .mgz"},
    ForeignSignature{0, "#!TDV", "a Tecplot file; resample it to .vti, e.g. with ParaView"},
    ForeignSignature{0, "GRIB", "a GRIB file; convert it to netCDF, e.g. with: cdo -f nc copy IN.grb OUT.nc"},
    ForeignSignature{0, "SIMPLE  =", "a FITS image; save its array as .npy (astropy.io.fits)"},
    ForeignSignature{0, "SQLite format 3", "an SQLite database"},
    ForeignSignature{0, "PAR1", "a table (Parquet)"},
};

// Content that some readers accept, or that only a wrong name hides.
constexpr std::array kForeignElse{
    ForeignSignature{0, "MATLAB 7.3 MAT-file",
                     "a MATLAB 7.3 file; save the array as .nii or raw data in MATLAB (niftiwrite, fwrite)"},
    ForeignSignature{0, "MATLAB 5.0 MAT-file",
                     "a MATLAB file; save the array as .nii in MATLAB (niftiwrite) or as .npy (scipy.io.loadmat)"},
    ForeignSignature{
        0, "\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "a file of OLE2 containers, such as Olympus OIB or an Office document; save the image as OME-TIFF, "
        "e.g. with bfconvert or Fiji"},
    ForeignSignature{0, "GIF8", "a GIF picture; save its frames as TIFF or PNG"},
    ForeignSignature{8, "WEBP", "a WebP picture; save it as TIFF or PNG"},
    ForeignSignature{8, "AVI ", "a film (AVI); save its frames as TIFF or PNG"},
    ForeignSignature{4, "ftyp", "a film (MP4); save its frames as TIFF or PNG"},
    ForeignSignature{0, "\x1a\x45\xdf\xa3", "a film (Matroska); save its frames as TIFF or PNG"},
    ForeignSignature{0,
                     "\x7f"
                     "ELF",
                     "a program"},
    ForeignSignature{0, "{\\rtf", "a text document (RTF)"},
    ForeignSignature{0, "\x80\x04\x95", "a Python pickle; save the array as .npy (numpy.save)"},
    ForeignSignature{0, "\x80\x03", "a Python pickle; save the array as .npy (numpy.save)"},
};

struct ForeignName {
    std::string_view ending, what;
};
constexpr std::array kForeignNames{
    ForeignName{".stl", "a surface (STL); expected a volume"},
    ForeignName{".obj", "a surface (OBJ); expected a volume"},
    ForeignName{".rec", "samples of a Philips scan without header; convert the PAR beside it with: dcm2niix"},
    ForeignName{"2dseq", "samples of Bruker ParaVision without header; convert the study with: dcm2niix"},
    ForeignName{".brik", "samples of AFNI; convert them with: 3dAFNItoNIFTI"},
    ForeignName{".head", "a header of AFNI; convert it with: 3dAFNItoNIFTI"},
    ForeignName{".lif", "a Leica LIF image; save it as OME-TIFF, e.g. with bfconvert or Fiji"},
    ForeignName{".vmr", "a BrainVoyager image; save it as NIfTI"},
    ForeignName{".vgi", "a header of VGStudio; describe the samples in the .vol beside it with --raw"},
};

std::string foreign_lower(std::string_view text) {
    std::string lower;
    for (const char c : text)
        lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower;
}

std::string_view without_blanks(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0)
        text.remove_prefix(1);
    return text;
}

bool is_web_page(std::string_view head) {
    const std::string begin = foreign_lower(without_blanks(head).substr(0, 400));
    return begin.starts_with("<!doctype html") || begin.starts_with("<html") ||
           (begin.starts_with("<") && begin.find("<html") != std::string::npos);
}

template <std::size_t n>
std::string_view foreign_in(const std::array<ForeignSignature, n>& table, std::string_view head) {
    for (const ForeignSignature& known : table)
        if (head.size() >= known.offset && head.substr(known.offset).starts_with(known.bytes)) return known.what;
    return {};
}

// The name of the first element.
std::string xml_root(std::string_view head) {
    auto at = head.find('<');
    while (at != std::string_view::npos && at + 1 < head.size() && (head[at + 1] == '?' || head[at + 1] == '!'))
        at = head.find('<', at + 1);
    if (at == std::string_view::npos) return {};
    std::string name;
    for (const char c : head.substr(at + 1, 60)) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != ':' && c != '_' && c != '-') break;
        name += c;
    }
    return name;
}

std::string text_kind(std::string_view head) {
    const auto text = without_blanks(head);
    if (text.starts_with("<?xml") || text.starts_with("<")) {
        const std::string root = xml_root(text), lower = foreign_lower(root);
        if (lower == "gifti") return "a surface (GIFTI); expected a volume";
        if (lower == "bxh") return "a BXH header; convert it with: bxh2analyze --niftihdr";
        if (lower == "xdmf") return "an XDMF file; save the data as .vti with ParaView, or open its HDF5 file";
        if (lower == "voreendata") return "a workspace or header of Voreen; save the volume as .dat or NRRD";
        if (!root.empty()) return fmt::format("an XML file ({})", root);
        return "an XML file";
    }
    if (text.starts_with("{") || text.starts_with("[")) return "a JSON file; of a Zarr store, open its folder";
    const auto first_line = text.substr(0, text.find('\n'));
    const auto numbers = std::ranges::count(first_line, ',') + std::ranges::count(first_line, ';') +
                         std::ranges::count(first_line, '\t');
    if (numbers > 0) return "a table of text (CSV); save the array as .npy (numpy.save)";
    return "a text file";
}

bool is_printed(std::string_view head) {
    return std::ranges::all_of(head, [](char c) {
        const auto code = static_cast<unsigned char>(c);
        return code >= ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\f';
    });
}

}  // namespace

void refuse_foreign(const std::string& path, std::string_view head) {
    if (is_web_page(head))
        fail("{}: a web page (HTML), not a volume: a download that failed, or that asks to log in", path);
    if (without_blanks(head).starts_with('<') && head.substr(0, 300).find("<Error><Code>") != std::string_view::npos)
        fail("{}: an error message of a storage service, not a volume: a download that failed", path);
    if (const auto what = foreign_in(kForeignAlways, head); !what.empty()) fail("{}: {}", path, what);
}

std::string foreign_kind(const std::string& path, std::string_view head) {
    if (const auto what = foreign_in(kForeignElse, head); !what.empty()) return std::string(what);
    const std::string lower = foreign_lower(path);
    for (const ForeignName& known : kForeignNames)
        if (lower.ends_with(known.ending)) return std::string(known.what);
    if (head.starts_with("solid ") && head.find("facet") != std::string_view::npos)
        return "a surface (STL); expected a volume";
    if (is_printed(head)) return text_kind(head);
    if (std::ranges::all_of(head, [](char c) { return c == '\0'; }))
        return "it begins with zeros: samples without header, or a download that stopped";
    return "";
}

}  // namespace edgesplat::detail
