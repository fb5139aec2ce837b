// VTK files: legacy and XML, image data and rectilinear grids.
#include <zlib.h>

#include <array>
#include <bit>
#include <cstring>

#include "tests/unit/volume_test_files.h"

namespace {

namespace fs = std::filesystem;
using edgesplat::load_volume;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using volume_test::data;
using volume_test::refusal;

class Vtk : public volume_test::FolderTest {};

constexpr const char* kVtkHead = "# vtk DataFile Version 3.0\ntitle\n";

template <typename T>
std::string vtk_bytes(std::initializer_list<T> values, bool big) {
    std::string bytes;
    for (const T value : values) {
        std::array<char, sizeof(T)> raw{};
        std::memcpy(raw.data(), &value, sizeof(T));
        if (big != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
        bytes.append(raw.data(), raw.size());
    }
    return bytes;
}

std::string vtk_base64(const std::string& bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= bytes.size() - i ? kDigits[bits >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

TEST_F(Vtk, LegacyTextWithFieldsInAnyOrder) {
    const std::string text = std::string(kVtkHead) +
                             "ascii\ndataset STRUCTURED_POINTS\nORIGIN 1 2 3\nSPACING 0.5 1 2\nDIMENSIONS 2 2 2\n"
                             "FIELD FieldData 1\nTIME 1 1 double\n7\nPOINT_DATA 8\nSCALARS a%20b short\n"
                             "LOOKUP_TABLE default\n1 2 3 4\n5 6 7 -8\nVECTORS v float\n";
    std::string vectors;
    for (int i = 0; i < 24; ++i)
        vectors += std::to_string(i) + " ";
    const auto volume = load_volume(write("a.vtk", text + vectors));
    EXPECT_THAT(volume.values, ElementsAre(1, 2, 3, 4, 5, 6, 7, -8));
    EXPECT_EQ(volume.geometry.spacing(), glm::dvec3(0.5, 1, 2));
    EXPECT_EQ(volume.geometry.origin, glm::dvec3(1, 2, 3));
    EXPECT_EQ(volume.geometry_source, "ORIGIN, SPACING");
    EXPECT_EQ(volume.stored_type, "int16");
    EXPECT_EQ(load_volume(file("a.vtk") + ":a b").values, volume.values);
    EXPECT_EQ(load_volume(file("a.vtk") + ":PointData/v", {.component = 2}).values[1], 5.0F);
    EXPECT_THAT(refusal(file("a.vtk") + ":v"), HasSubstr("--component 0..2"));
    EXPECT_THAT(refusal(file("a.vtk") + ":w"), HasSubstr("expected one of a b (int16), v (float32, 3 components)"));
}

TEST_F(Vtk, LegacyBinaryIsBigEndianAndSkipsOtherArrays) {
    const std::string head = std::string(kVtkHead) + "BINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\n" +
                             "POINT_DATA 4\nFIELD FieldData 2\nfirst 1 4 int\n";
    const std::string text = head + vtk_bytes<std::int32_t>({1, 2, 3, 0x0a0a0a}, true) +
                             "\nMETADATA\nINFORMATION 0\n\nsecond 1 4 float\n" +
                             vtk_bytes<float>({-1, 0.5, 2, 8}, true) + "\nMETADATA\nINFORMATION 0\n\n";
    const auto shown = load_volume(write("a.vtk", text));  // as ParaView does
    EXPECT_THAT(shown.values, ElementsAre(1, 2, 3, 0x0a0a0a));
    EXPECT_THAT(shown.warnings, ElementsAre(AllOf(HasSubstr("'first' is shown"), HasSubstr("second (float32)"))));
    EXPECT_THAT(load_volume(file("a.vtk") + ":second").values, ElementsAre(-1, 0.5F, 2, 8));
    EXPECT_THAT(load_volume(file("a.vtk") + ":first").values, ElementsAre(1, 2, 3, 0x0a0a0a));
    for (const std::size_t lost : {40U, 60U, 100U})
        EXPECT_THAT(refusal(write("b.vtk", text.substr(0, text.size() - lost)) + ":second"), HasSubstr("b.vtk"));
}

TEST_F(Vtk, LegacyLongHasFourOrEightBytes) {
    const std::string head = std::string(kVtkHead) + "BINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 1 1\n" +
                             "POINT_DATA 2\nSCALARS a unsigned_long 1\nLOOKUP_TABLE default\n";
    EXPECT_THAT(load_volume(write("a.vtk", head + vtk_bytes<std::uint32_t>({5, 6}, true) + "\n")).values,
                ElementsAre(5, 6));
    EXPECT_THAT(load_volume(write("b.vtk", head + vtk_bytes<std::uint64_t>({5, 6}, true) + "\n")).values,
                ElementsAre(5, 6));
}

TEST_F(Vtk, CellsAreHalfACellIn) {
    const std::string text = std::string(kVtkHead) +
                             "ASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 1\nSPACING 1 2 0\nORIGIN 10 20 30\n"
                             "CELL_DATA 2\nSCALARS a float\nLOOKUP_TABLE default\n1 2\n";
    const auto volume = load_volume(write("a.vtk", text));
    EXPECT_EQ(volume.geometry.dims, glm::ivec3(2, 1, 1));
    EXPECT_EQ(volume.geometry.origin, glm::dvec3(10.5, 21, 30));
    EXPECT_THAT(volume.notes, testing::Contains(HasSubstr("1 mm thick")));
}

TEST_F(Vtk, LegacyRefusals) {
    const auto of = [&](const std::string& geometry, const std::string& samples) {
        return refusal(write("a.vtk", kVtkHead + std::string("ASCII\nDATASET ") + geometry + samples));
    };
    const std::string points = "STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n", eight = "1 2 3 4 5 6 7 8\n";
    const std::string scalars = "SCALARS a int\nLOOKUP_TABLE default\n";
    EXPECT_THAT(of(points, "POINT_DATA 9\n" + scalars + eight),
                HasSubstr("POINT_DATA 9, but DIMENSIONS have 8 points"));
    EXPECT_THAT(of(points, "POINT_DATA 8\n" + scalars + "1 2 3"), HasSubstr("array a with 3 of 8 values"));
    EXPECT_THAT(of(points, "POINT_DATA 8\n" + scalars + "1 2 3 4.5 5 6 7 8"), HasSubstr("'4.5' is no int32"));
    EXPECT_THAT(of(points + "SPACING 1 nan 1\n", "POINT_DATA 8\n" + scalars + eight), HasSubstr("spacing 1 nan 1"));
    EXPECT_THAT(of(points + "SPACING 1 0 1\n", "POINT_DATA 8\n" + scalars + eight), HasSubstr("above 0"));
    EXPECT_THAT(of(points + "SPACING 1 -1 1\n", "POINT_DATA 8\n" + scalars + eight), HasSubstr("above 0"));
    EXPECT_THAT(of(points, "POINT_DATA 8\nSCALARS a bit\nLOOKUP_TABLE default\n" + eight), HasSubstr("type bit"));
    EXPECT_THAT(of(points, "POINT_DATA 8\nSCALARS a complex\nLOOKUP_TABLE default\n" + eight), HasSubstr("'complex'"));
    EXPECT_THAT(of(points, ""), HasSubstr("without samples"));
    EXPECT_THAT(of("UNSTRUCTURED_GRID\n", ""), AllOf(HasSubstr("unstructured_grid"), HasSubstr("Resample To Image")));
    EXPECT_THAT(of("STRUCTURED_POINTS\nDIMENSIONS 60000 60000 60000\n", "POINT_DATA 216000000000000\n" + scalars + "1"),
                HasSubstr("a.vtk"));
    EXPECT_THAT(of("STRUCTURED_POINTS\nDIMENSIONS 2000000000 2000000000 2000000000\n", "POINT_DATA 1\n"),
                HasSubstr("POINT_DATA 1"));
    EXPECT_THAT(of(points, "POINT_DATA 8\nFIELD f 1\nb 1 9223372036854775807 double\n" + eight), HasSubstr("array b"));
}

TEST_F(Vtk, LegacyRectilinearGridWithEvenCoordinates) {
    const auto of = [&](const std::string& x) {
        return write("a.vtk", kVtkHead + std::string("ASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 3 2 2\n") +
                                  "X_COORDINATES 3 float\n" + x + "\nY_COORDINATES 2 float\n5 7\nZ_COORDINATES 2 " +
                                  "double\n-1 2\nPOINT_DATA 12\nSCALARS a float\nLOOKUP_TABLE t\n" +
                                  "0 1 2 3 4 5 6 7 8 9 10 11\n");
    };
    const auto volume = load_volume(of("1.1 1.2000001 1.3"));
    EXPECT_NEAR(volume.geometry.spacing().x, 0.1, 1e-6);
    EXPECT_EQ(volume.geometry.spacing().z, 3);
    EXPECT_NEAR(volume.geometry.origin.x, 1.1, 1e-6);
    EXPECT_THAT(refusal(of("1 2 4")), HasSubstr("uneven coordinates along x: number 1 is 2, expected 2.5"));
    EXPECT_THAT(refusal(of("1 1 1")), HasSubstr("ascending"));
    // Coordinates that descend: a mirrored volume.
    EXPECT_EQ(load_volume(of("3 2 1")).geometry.index_to_world_axes[0], glm::dvec3(-1, 0, 0));
}

std::string vtk_xml(const std::string& attributes, const std::string& image, const std::string& content,
                    const std::string& appended = "") {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" " + attributes + ">\n<ImageData " +
           image + ">\n" + content + "</ImageData>\n" + appended + "</VTKFile>\n";
}
std::string vtk_piece(const std::string& extent, const std::string& array) {
    return "<Piece Extent=\"" + extent + "\"><PointData Scalars=\"a\">" + array + "</PointData></Piece>\n";
}

TEST_F(Vtk, XmlEncodings) {
    const std::string image = R"(WholeExtent="2 3 0 1 0 0" Origin="1 2 3" Spacing="2 1 4")";
    const auto array = [](const std::string& rest) { return "<DataArray type=\"Int16\" Name=\"a\" " + rest; };
    const std::string extent = "2 3 0 1 0 0";
    for (const bool big : {false, true})
        for (const bool wide : {false, true}) {
            const std::string attributes = std::string("byte_order=\"") + (big ? "BigEndian" : "LittleEndian") +
                                           "\" header_type=\"" + (wide ? "UInt64" : "UInt32") + "\"";
            const auto word = [&](std::uint32_t n) {
                return wide ? vtk_bytes<std::uint64_t>({n}, big) : vtk_bytes<std::uint32_t>({n}, big);
            };
            const std::string samples = vtk_bytes<std::int16_t>({1, -2, 300, 4}, big);
            std::string packed(200, '\0');
            uLongf size = packed.size();
            ASSERT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(samples.data()), samples.size()),
                      Z_OK);
            packed.resize(size);
            const std::string blocks = word(1) + word(8) + word(0) + word(static_cast<std::uint32_t>(size));
            const std::string zlib = attributes + " compressor=\"vtkZLibDataCompressor\"";
            const std::string appended = "<AppendedData encoding=\"raw\">\n_" + std::string("junk");
            const std::vector<std::string> files{
                vtk_xml(attributes, image, vtk_piece(extent, array("format=\"ascii\">1 -2 300\n4</DataArray>"))),
                vtk_xml(attributes, image,
                        vtk_piece(extent,
                                  array("format=\"binary\">\n  " + vtk_base64(word(8) + samples) + "\n</DataArray>"))),
                vtk_xml(attributes, image,
                        vtk_piece(extent, array("format=\"binary\">" + vtk_base64(word(8)) + vtk_base64(samples) +
                                                "</DataArray>"))),
                vtk_xml(zlib, image,
                        vtk_piece(extent, array("format=\"binary\">" + vtk_base64(blocks) + vtk_base64(packed) +
                                                "</DataArray>"))),
                vtk_xml(attributes, image, vtk_piece(extent, array("format=\"appended\" offset=\"4\"/>")),
                        appended + word(8) + samples + "\n</AppendedData>"),
                vtk_xml(zlib, image, vtk_piece(extent, array("format=\"appended\" offset=\"4\"/>")),
                        appended + blocks + packed + "\n</AppendedData>")};
            for (std::size_t i = 0; i < files.size(); ++i) {
                const auto volume = load_volume(write("a.vti", files[i]));
                EXPECT_THAT(volume.values, ElementsAre(1, -2, 300, 4)) << i;
                EXPECT_EQ(volume.geometry.origin, glm::dvec3(5, 2, 3));
                EXPECT_EQ(volume.geometry.spacing(), glm::dvec3(2, 1, 4));
                // Truncated anywhere: refused in one line.
                for (std::size_t kept = 0; kept + 30 < files[i].size(); kept += 37)
                    EXPECT_THAT(refusal(write("b.vti", files[i].substr(0, std::max<std::size_t>(kept, 1)))),
                                HasSubstr("b.vti"));
            }
        }
}

TEST_F(Vtk, XmlDirectionAndComponents) {
    const std::string image =
        "WholeExtent=\"0 1 0 0 0 0\" Origin=\"0 0 0\" Spacing=\"2 3 4\" "
        "Direction=\"0 -1 0 1 0 0 0 0 1\"";
    const std::string array =
        "<DataArray type=\"Float32\" Name=\"a\" NumberOfComponents=\"2\" format=\"ascii\">1 2 3 "
        "4</DataArray>";
    const auto volume =
        load_volume(write("a.vti", vtk_xml("", image, vtk_piece("0 1 0 0 0 0", array))), {.component = 1});
    EXPECT_THAT(volume.values, ElementsAre(2, 4));
    EXPECT_EQ(volume.geometry.index_to_world_axes[0], glm::dvec3(0, 2, 0));
    EXPECT_EQ(volume.geometry.index_to_world_axes[1], glm::dvec3(-3, 0, 0));
    EXPECT_EQ(volume.geometry_source, "Origin, Spacing, Direction");
    EXPECT_THAT(refusal(file("a.vti")), HasSubstr("--component 0..1"));
}

TEST_F(Vtk, XmlPiecesAndParallelFiles) {
    const auto array = [](const std::string& numbers) {
        return "<DataArray type=\"UInt8\" Name=\"a\" format=\"ascii\">" + numbers + "</DataArray>";
    };
    const std::string left = vtk_piece("0 1 0 1 0 0", array("1 2 4 5")),
                      right = vtk_piece("1 2 0 1 0 0", array("2 3 5 6"));
    const std::string image = "WholeExtent=\"0 2 0 1 0 0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"";
    EXPECT_THAT(load_volume(write("a.vti", vtk_xml("", image, left + right))).values, ElementsAre(1, 2, 3, 4, 5, 6));
    EXPECT_THAT(refusal(write("b.vti", vtk_xml("", image, left))), HasSubstr("leave 2 of 6 samples"));
    write("l.vti", vtk_xml("", "WholeExtent=\"0 1 0 1 0 0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"", left));
    write("r.vti", vtk_xml("", "WholeExtent=\"1 2 0 1 0 0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"", right));
    const std::string parallel =
        "<VTKFile type=\"PImageData\"><PImageData GhostLevel=\"0\" " + image +
        "><PPointData Scalars=\"a\"><PDataArray type=\"UInt8\" Name=\"a\"/></PPointData>"
        "<Piece Extent=\"0 1 0 1 0 0\" Source=\"l.vti\"/><Piece Extent=\"1 2 0 1 0 0\" Source=\"r.vti\"/></PImageData>"
        "</VTKFile>";
    EXPECT_THAT(load_volume(write("a.pvti", parallel)).values, ElementsAre(1, 2, 3, 4, 5, 6));
    fs::remove(file("r.vti"));
    EXPECT_THAT(refusal(file("a.pvti")), HasSubstr("r.vti: no such file"));
}

TEST_F(Vtk, HiddenPointsAreNoData) {
    const std::string arrays =
        "<DataArray type=\"Float32\" Name=\"a\" format=\"ascii\">1 2 3</DataArray>"
        "<DataArray type=\"UInt8\" Name=\"vtkGhostType\" format=\"ascii\">0 2 1</DataArray>";
    const auto volume =
        load_volume(write("a.vti", vtk_xml("", "WholeExtent=\"0 2 0 0 0 0\"", vtk_piece("0 2 0 0 0 0", arrays))));
    EXPECT_EQ(volume.non_finite_count, 1U);
    EXPECT_EQ(volume.max_value, 3);
    EXPECT_EQ(volume.geometry_source, "none: 1 mm assumed");
}

TEST_F(Vtk, XmlRefusals) {
    const std::string array = "<DataArray type=\"UInt8\" Name=\"a\" format=\"ascii\">1 2</DataArray>";
    const auto of = [&](const std::string& image, const std::string& extent, const std::string& attributes = "") {
        return refusal(write("a.vti", vtk_xml(attributes, image, vtk_piece(extent, array))));
    };
    const std::string two = "0 1 0 0 0 0", whole = "WholeExtent=\"0 1 0 0 0 0\"";
    EXPECT_THAT(of(whole + " Spacing=\"1 nan 1\"", two), HasSubstr("spacing 1 nan 1"));
    EXPECT_THAT(of(whole + " Spacing=\"1 1\"", two), HasSubstr("expected 3 numbers"));
    EXPECT_THAT(of(whole + " Direction=\"1 0 0 0 1 0 0 0 0\"", two), HasSubstr("determinant"));
    EXPECT_THAT(of(whole, "0 2 0 0 0 0"), HasSubstr("leaves WholeExtent"));
    EXPECT_THAT(of("WholeExtent=\"0 -1 0 0 0 0\"", two), HasSubstr("is empty"));
    EXPECT_THAT(of("WholeExtent=\"0 2147483000 0 2147483000 0 0\"", two), HasSubstr("at most"));
    EXPECT_THAT(of("WholeExtent=\"0 40000 0 1000 0 0\"", two), HasSubstr("only"));
    EXPECT_THAT(of(whole, two, "compressor=\"vtkBrotli\""), HasSubstr("compressor 'vtkBrotli'"));
    EXPECT_THAT(of(whole, two, "byte_order=\"Middle\""), HasSubstr("byte_order"));
    const auto kind = [&](const std::string& type) {
        return refusal(write("a.vtu", "<VTKFile type=\"" + type + "\"><" + type + "/></VTKFile>"));
    };
    EXPECT_THAT(kind("UnstructuredGrid"), AllOf(HasSubstr("an unstructured grid"), HasSubstr("Resample To Image")));
    EXPECT_THAT(kind("PPolyData"), HasSubstr("a surface"));
    EXPECT_THAT(refusal(write("a.pvd",
                              "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" "
                              "file=\"t0.vti\"/></Collection></VTKFile>")),
                HasSubstr("t0.vti"));
}

TEST_F(Vtk, ReportedCases) {
    if (!fs::exists(data("odd/cases/vtk"))) GTEST_SKIP() << "no folder odd/cases in EDGESPLAT_DATA";
    const auto field = load_volume(data("odd/cases/vtk/d_binary_field.vtk") + ":CT");
    const auto cells = load_volume(data("odd/cases/vtk/e_cell_scalars.vtk"));
    for (const auto* volume : {&field, &cells}) {
        EXPECT_EQ(volume->geometry.dims, glm::ivec3(40, 44, 24));
        EXPECT_EQ(volume->geometry.spacing(), glm::dvec3(1.6, 1.6, 2.8));
        EXPECT_LT(glm::length(volume->geometry.origin - glm::dvec3(-31.2, -34.4, -32.2)), 1e-12);
        EXPECT_EQ(volume->max_value, 1000);
    }
    EXPECT_EQ(field.values, cells.values);
    const auto first = load_volume(data("odd/cases/vtk/d_binary_field.vtk"));
    EXPECT_EQ(first.values, field.values);
    EXPECT_THAT(first.warnings, Contains(HasSubstr("other (int16)")));
}

}  // namespace
