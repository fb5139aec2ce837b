// Packed volumes: every level round-trips, and damaged files are refused.
#include "engine/volume/packed_volume.h"

#include <hdf5.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <thread>

#include "engine/volume/pack_volume.h"
#include "tests/unit/volume_test_files.h"

namespace {

using edgesplat::PackedVolume;
using edgesplat::Volume;
using testing::HasSubstr;

using PackedVolumeTest = volume_test::FolderTest;

/// A volume in which neighbours differ; the formula does not repeat within a brick.
Volume volume_of(const glm::ivec3& dims, const std::function<float(int hash)>& value) {
    Volume volume;
    volume.name = "made here";
    volume.stored_type = "float64";
    volume.in_patient = true;
    volume.notes = {"First note.", "Second note."};
    volume.geometry.dims = dims;
    const volume_test::Place place;
    for (int axis = 0; axis < 3; ++axis)
        volume.geometry.index_to_world_axes[axis] = place.directions[axis] * place.spacing[axis];
    volume.geometry.origin = place.origin;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x)
                volume.values.push_back(value((x * 7919 + y * 104729 + z * 1299709 + x * y * 31 + y * z * 17) % 65521));
    finish_volume(volume);
    return volume;
}

float as_uint8(int hash) {
    return static_cast<float>(hash % 256);
}
float as_int16(int hash) {
    return static_cast<float>(hash - 32768);
}
float as_uint16(int hash) {
    return static_cast<float>(hash);
}
float as_float(int hash) {
    return static_cast<float>(hash) / 7 - 100;
}

std::vector<float> all_of(const PackedVolume& packed, int level) {
    std::vector<float> values(packed.geometry(level).voxel_count());
    packed.read(level, glm::ivec3(0), packed.geometry(level).dims, values);
    return values;
}

struct Type {
    const char* name;
    float (*value)(int hash);
};

void PrintTo(const Type& type, std::ostream* out) {
    *out << type.name;
}

class PackedTypes : public volume_test::FolderTest, public testing::WithParamInterface<Type> {};

TEST_P(PackedTypes, RoundTripIsExact) {
    for (const bool compress : {false, true}) {
        const Volume volume = volume_of({67, 33, 41}, GetParam().value);
        const std::string path = file(compress ? "small.esv" : "vol.esv");
        const auto summary = pack_volume(volume, path, {.compress = compress});
        EXPECT_EQ(summary.sample_type, GetParam().name);
        EXPECT_EQ(summary.bytes, std::filesystem::file_size(path));
        EXPECT_EQ(summary.quantisation_error, 0);

        const Volume opened = edgesplat::load_volume(path);
        ASSERT_NE(opened.packed, nullptr);
        EXPECT_TRUE(opened.values.empty());
        EXPECT_EQ(opened.name, path);
        EXPECT_EQ(opened.packed->source(), "made here");
        EXPECT_EQ(opened.packed->sample_type(), GetParam().name);
        EXPECT_EQ(opened.stored_type, volume.stored_type);
        EXPECT_EQ(opened.notes, volume.notes);
        EXPECT_TRUE(opened.in_patient);
        EXPECT_EQ(opened.min_value, volume.min_value);
        EXPECT_EQ(opened.max_value, volume.max_value);
        EXPECT_EQ(opened.checksum, volume.checksum);
        EXPECT_EQ(opened.geometry.dims, volume.geometry.dims);
        EXPECT_EQ(opened.geometry.index_to_world_axes, volume.geometry.index_to_world_axes);
        EXPECT_EQ(opened.geometry.origin, volume.geometry.origin);
        EXPECT_EQ(all_of(*opened.packed, 0), volume.values);
        const Volume level = load_level(opened, 0);
        EXPECT_EQ(level.checksum, volume.checksum);
        EXPECT_EQ(value_at(opened, {66, 32, 40}), volume.at(66, 32, 40));
        EXPECT_EQ(value_at(volume, {3, 2, 1}), volume.at(3, 2, 1));
    }
}

TEST_P(PackedTypes, LevelsAreMeansOfFinerLevel) {
    const Volume volume = volume_of({261, 67, 35}, GetParam().value);
    const std::string path = file("vol.esv");
    pack_volume(volume, path);
    const auto packed = PackedVolume::open(path);
    ASSERT_EQ(packed->levels(), 4);
    const bool whole = packed->sample_type() != "float32";
    std::vector<float> finer = volume.values;
    for (int level = 1; level < packed->levels(); ++level) {
        const glm::ivec3 fine = packed->geometry(level - 1).dims, dims = packed->geometry(level).dims;
        ASSERT_EQ(dims, (fine + 1) / 2);
        const auto values = all_of(*packed, level);
        std::size_t at = 0;
        for (int z = 0; z < dims.z; ++z)
            for (int y = 0; y < dims.y; ++y)
                for (int x = 0; x < dims.x; ++x, ++at) {
                    double sum = 0;
                    int count = 0;
                    for (int corner = 0; corner < 8; ++corner) {
                        const glm::ivec3 p =
                            2 * glm::ivec3(x, y, z) + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
                        if (glm::any(glm::greaterThanEqual(p, fine))) continue;
                        sum +=
                            static_cast<double>(finer[static_cast<std::size_t>((p.z * fine.y + p.y) * fine.x + p.x)]);
                        ++count;
                    }
                    const double mean = sum / count;
                    const auto wanted = static_cast<float>(whole ? std::floor(mean + 0.5) : mean);
                    ASSERT_EQ(values[at], wanted) << level << ": " << x << ' ' << y << ' ' << z;
                }
        finer = values;
    }
}

INSTANTIATE_TEST_SUITE_P(EveryType, PackedTypes,
                         testing::Values(Type{"uint8", as_uint8}, Type{"int16", as_int16}, Type{"uint16", as_uint16},
                                         Type{"float32", as_float}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_F(PackedVolumeTest, LevelGeometryMatchesVoxelCentres) {
    const Volume volume = volume_of({200, 3, 130}, as_uint8);
    pack_volume(volume, file("vol.esv"));
    const Volume opened = edgesplat::open_packed(file("vol.esv"));
    ASSERT_EQ(opened.packed->levels(), 3);
    for (int level = 0; level < 3; ++level) {
        const auto& geometry = opened.packed->geometry(level);
        const double factor = std::exp2(level);
        // Voxel (1, 0, 2) of this level is the mean of a box of level 0; its centre is midway between the box's
        // corners.
        const glm::dvec3 first = factor * glm::dvec3(1, 0, 2), last = first + factor - 1.0;
        const auto middle = volume.geometry.to_world((first + last) / 2.0);
        EXPECT_LT(glm::length(geometry.to_world({1, 0, 2}) - middle), 1e-9) << level;
        EXPECT_EQ(load_level(opened, level).geometry.dims, geometry.dims);
    }
    EXPECT_EQ(opened.packed->geometry(2).dims, glm::ivec3(50, 1, 33));
    EXPECT_EQ(finest_level_within(*opened.packed, 200 * 3 * 130), 0);
    EXPECT_EQ(finest_level_within(*opened.packed, 200 * 3 * 130 - 1), 1);
    EXPECT_EQ(finest_level_within(*opened.packed, 1), 2);
}

TEST_F(PackedVolumeTest, RangesBoundSamplesTightly) {
    const Volume volume = volume_of({67, 33, 70}, as_float);
    pack_volume(volume, file("vol.esv"));
    const auto packed = PackedVolume::open(file("vol.esv"));
    for (int level = 0; level < packed->levels(); ++level) {
        const auto values = all_of(*packed, level);
        const glm::ivec3 dims = packed->geometry(level).dims;
        const auto range_of = [&](const glm::ivec3& low, const glm::ivec3& high) {
            PackedVolume::Range range{INFINITY, -INFINITY};
            for (int z = low.z; z < high.z; ++z)
                for (int y = low.y; y < high.y; ++y)
                    for (int x = low.x; x < high.x; ++x) {
                        const float value = values[static_cast<std::size_t>((z * dims.y + y) * dims.x + x)];
                        range = {std::min(range.low, value), std::max(range.high, value)};
                    }
            return range;
        };
        for (int z = 0; z < dims.z; z += 32)
            for (int y = 0; y < dims.y; y += 32)
                for (int x = 0; x < dims.x; x += 32) {
                    const glm::ivec3 low(x, y, z), high = glm::min(low + 32, dims);
                    const auto range = packed->range(level, low, high - low), wanted = range_of(low, high);
                    EXPECT_EQ(range.low, wanted.low);
                    EXPECT_EQ(range.high, wanted.high);
                }
        // Across bricks the range may be wider than that of the box.
        const glm::ivec3 low = dims / 3, high = dims - dims / 4;
        const auto range = packed->range(level, low, high - low), inside = range_of(low, high);
        EXPECT_LE(range.low, inside.low);
        EXPECT_GE(range.high, inside.high);
    }
}

TEST_F(PackedVolumeTest, ReadsBoxesAtBordersAndAcrossBricks) {
    const Volume volume = volume_of({67, 33, 41}, as_int16);
    pack_volume(volume, file("vol.esv"), {.compress = true});
    const auto packed = PackedVolume::open(file("vol.esv"));
    const auto expect_box = [&](const glm::ivec3& low, const glm::ivec3& size) {
        std::vector<float> values(static_cast<std::size_t>(size.x * size.y * size.z));
        packed->read(0, low, size, values);
        std::size_t at = 0;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    ASSERT_EQ(values[at++], volume.at(low.x + x, low.y + y, low.z + z));
    };
    expect_box({0, 0, 0}, {1, 1, 1});
    expect_box({66, 32, 40}, {1, 1, 1});
    expect_box({31, 31, 31}, {2, 2, 2});
    expect_box({64, 0, 32}, {3, 33, 9});
    expect_box({5, 7, 0}, {60, 3, 41});
    std::vector<float> eight(8);
    EXPECT_THROW(packed->read(0, {66, 0, 0}, {2, 2, 2}, eight), edgesplat::Error);
    EXPECT_THROW(packed->read(0, {-1, 0, 0}, {2, 2, 2}, eight), edgesplat::Error);
    EXPECT_THROW(packed->read(0, {0, 0, 0}, {2, 2, 0}, eight), edgesplat::Error);
    EXPECT_THROW(packed->read(0, {0, 0, 0}, {2, 2, 1}, eight), edgesplat::Error);
    EXPECT_THROW(packed->read(2, {0, 0, 0}, {2, 2, 2}, eight), edgesplat::Error);
    EXPECT_THROW((void)packed->range(0, {0, 0, 0}, {68, 1, 1}), edgesplat::Error);
    EXPECT_THROW((void)packed->geometry(-1), edgesplat::Error);
}

TEST_F(PackedVolumeTest, FourThreadsReadConcurrently) {
    const Volume volume = volume_of({100, 80, 90}, as_uint16);
    pack_volume(volume, file("vol.esv"), {.compress = true});
    const auto packed = PackedVolume::open(file("vol.esv"));
    std::vector<int> wrong(4, 0);
    {
        std::vector<std::jthread> pool;
        for (int t = 0; t < 4; ++t)
            pool.emplace_back([&, t] {
                std::vector<float> values(20 * 20 * 20);
                for (int i = 0; i < 50; ++i) {
                    const glm::ivec3 low((t * 20 + i * 3) % 80, (i * 7) % 60, (i * 11 + t) % 70);
                    packed->read(0, low, glm::ivec3(20), values);
                    for (int at = 0; at < 8000; ++at)
                        wrong[static_cast<std::size_t>(t)] +=
                            values[static_cast<std::size_t>(at)] !=
                            volume.at(low.x + at % 20, low.y + at / 20 % 20, low.z + at / 400);
                }
            });
    }
    EXPECT_THAT(wrong, testing::Each(0));
}

TEST_F(PackedVolumeTest, ReplacesAndCountsNonFiniteSamples) {
    Volume volume = volume_of({40, 40, 40}, as_uint8);
    Volume spoilt = volume;
    for (const std::size_t at : {0U, 777U, 40U * 40 * 40 - 1}) {
        spoilt.values[at] = at == 777 ? INFINITY : NAN;
        volume.values[at] = 0;
    }
    finish_volume(volume);
    pack_volume(spoilt, file("vol.esv"));
    const Volume opened = edgesplat::open_packed(file("vol.esv"));
    EXPECT_EQ(opened.non_finite_count, 3U);
    EXPECT_EQ(opened.packed->sample_type(), "uint8");
    EXPECT_EQ(opened.checksum, volume.checksum);
    EXPECT_EQ(load_level(opened, 0).values, volume.values);
}

TEST_F(PackedVolumeTest, QuantisesWithinStatedError) {
    const Volume volume = volume_of({67, 33, 41}, as_float);
    for (const int bits : {8, 16}) {
        const std::string path = file(fmt::format("{}.esv", bits));
        const auto summary = pack_volume(volume, path, {.quantise = bits});
        EXPECT_EQ(summary.sample_type, fmt::format("uint{}", bits));
        const Volume opened = edgesplat::open_packed(path);
        const auto values = all_of(*opened.packed, 0);
        double worst = 0;
        for (std::size_t i = 0; i < values.size(); ++i)
            worst = std::max(worst, std::abs(static_cast<double>(values[i]) - static_cast<double>(volume.values[i])));
        EXPECT_NEAR(opened.packed->quantisation_error(), worst, 1e-12);
        const double step = static_cast<double>(volume.max_value - volume.min_value) / (std::exp2(bits) - 1);
        EXPECT_LE(worst, 0.5 * step * 1.02);
        EXPECT_GT(worst, 0.4 * step);
        EXPECT_EQ(load_level(opened, 0).checksum, opened.checksum);
        EXPECT_EQ(load_level(opened, 0).max_value, opened.max_value);
        EXPECT_THAT(opened.notes.back(), HasSubstr("Quantised"));
        const auto range = opened.packed->range(0, glm::ivec3(0), volume.geometry.dims);
        EXPECT_EQ(range.low, opened.min_value);
        EXPECT_EQ(range.high, opened.max_value);
    }
    // Values that fit the type are stored exactly.
    EXPECT_EQ(pack_volume(volume_of({5, 5, 5}, as_int16), file("exact.esv"), {.quantise = 16}).sample_type, "int16");
    EXPECT_THROW(pack_volume(volume, file("12.esv"), {.quantise = 12}), edgesplat::Error);
}

TEST_F(PackedVolumeTest, StatisticsCoverAllSamples) {
    const Volume volume = volume_of({90, 50, 40}, as_int16);
    pack_volume(volume, file("vol.esv"));
    const Volume opened = edgesplat::open_packed(file("vol.esv"));
    EXPECT_EQ(opened.packed->histogram().counts, histogram(volume, 4096).counts);
    double sum = 0;
    for (const float value : volume.values)
        sum += static_cast<double>(value);
    EXPECT_NEAR(opened.packed->mean(), sum / static_cast<double>(volume.values.size()), 1e-9);
}

TEST_F(PackedVolumeTest, BuiltinScenesEqualThoseInMemory) {
    for (const char* name : {"builtin:phantom:70x65x40", "builtin:sphere:66"}) {
        const Volume volume = edgesplat::load_volume(name);
        EXPECT_TRUE(edgesplat::pack_file(name, {}, file("vol.esv")).streamed);
        const Volume opened = edgesplat::open_packed(file("vol.esv"));
        EXPECT_EQ(opened.checksum, volume.checksum);
        EXPECT_EQ(load_level(opened, 0).values, volume.values);
        EXPECT_EQ(opened.geometry.index_to_world_axes, volume.geometry.index_to_world_axes);
    }
}

/// Packs the file by streaming and compares the result with load_volume.
void expect_streamed(const std::string& path, const std::string& packed, const edgesplat::LoadOptions& options = {}) {
    EXPECT_TRUE(edgesplat::pack_file(path, options, packed).streamed) << path;
    const Volume volume = edgesplat::load_volume(path, options), opened = edgesplat::open_packed(packed);
    EXPECT_EQ(opened.checksum, volume.checksum) << path;
    EXPECT_EQ(opened.packed->source(), volume.name);
    EXPECT_EQ(opened.geometry.index_to_world_axes, volume.geometry.index_to_world_axes) << path;
    EXPECT_EQ(opened.geometry.origin, volume.geometry.origin) << path;
    EXPECT_EQ(opened.in_patient, volume.in_patient) << path;
    EXPECT_EQ(opened.stored_type, volume.stored_type) << path;
    EXPECT_EQ(opened.notes, volume.notes) << path;
    EXPECT_EQ(load_level(opened, 0).values, volume.values) << path;
}

TEST_F(PackedVolumeTest, StreamsRawFiles) {
    std::string bytes = "head";
    for (int i = 0; i < 70 * 34 * 3; ++i) {
        bytes += static_cast<char>(i * 7);
        bytes += static_cast<char>(i / 37);
    }
    const std::string path = write("voxels.raw", bytes + "tail");
    for (const char* form :
         {"70x34x3:int16:little:1,2,3:4", "70x34x3:uint16:big:1,1,0.5:4", "35x34x3:float32:big:1,1,1:4"})
        expect_streamed(path, file("vol.esv"), {.raw = form});
    expect_streamed(path, file("vol.esv"), {.raw = "70x34x3:int16:little:1,2,3:4", .spacing = glm::dvec3(2, 2, 5)});
    const auto refusal = [&](const char* form) -> std::string {
        try {
            edgesplat::pack_file(path, {.raw = form}, file("no.esv"));
        } catch (const edgesplat::Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(refusal("70x34x4:int16:little:1,2,3:4"), HasSubstr("needs 19040 after skipping 4"));
    EXPECT_THAT(refusal("70x34x1048577:int16:little"), HasSubstr("expected 1 to 1048576"));
    EXPECT_THAT(refusal("1048576x1048576x2:int16:little"), HasSubstr("2^40"));
    EXPECT_THAT(refusal("70x0x4:int16:little"), HasSubstr("expected 1 to 1048576"));
    EXPECT_FALSE(std::filesystem::exists(file("no.esv")));
}

TEST_F(PackedVolumeTest, StreamsUncompressedNrrdAndMetaImage) {
    const auto nrrd = itk::NrrdImageIO::New();
    const auto meta = itk::MetaImageIO::New();
    for (const char* name : {"a.nrrd", "a.nhdr"}) {
        volume_test::write_itk(nrrd, file(name));
        expect_streamed(file(name), file("vol.esv"));
    }
    for (const char* name : {"a.mha", "a.mhd"}) {
        volume_test::write_itk(meta, file(name));
        expect_streamed(file(name), file("vol.esv"));
    }
    // Big endian, byte skips from the start and from the end, patient space.
    std::string voxels;
    for (int i = 0; i < 60; ++i)
        voxels += {static_cast<char>(i / 9), static_cast<char>(i * 11)};
    write("voxels.bin", "12345" + voxels);
    for (const char* skip : {"5", "-1"})
        expect_streamed(write("b.nhdr", fmt::format("NRRD0005\ntype: short\ndimension: 3\nsizes: 5 4 3\n"
                                                    "space: right-anterior-superior\n"
                                                    "space directions: (2,0,0) (0,1,0.5) (0,0,3)\n"
                                                    "space origin: (1,2,3)\nencoding: raw\nendian: big\n"
                                                    "byte skip: {}\ndata file: voxels.bin\n",
                                                    skip)),
                        file("vol.esv"));
    write("plain.bin", voxels);
    expect_streamed(write("b.mhd",
                          "ObjectType = Image\nNDims = 3\nDimSize = 5 4 3\nElementSpacing = 1 2 3\n"
                          "BinaryData = True\nBinaryDataByteOrderMSB = True\nElementType = MET_SHORT\n"
                          "ElementDataFile = plain.bin\n"),
                    file("vol.esv"));
    // Compressed files are not streamed; the result is the same.
    volume_test::write_itk(nrrd, file("c.nrrd"), {}, true);
    EXPECT_FALSE(edgesplat::pack_file(file("c.nrrd"), {}, file("vol.esv")).streamed);
    EXPECT_EQ(edgesplat::open_packed(file("vol.esv")).checksum, edgesplat::load_volume(file("c.nrrd")).checksum);
    EXPECT_THROW(edgesplat::pack_file(file("vol.esv"), {}, file("twice.esv")), edgesplat::Error);
}

TEST_F(PackedVolumeTest, StoppingLeavesNoFile) {
    const Volume volume = volume_of({67, 33, 41}, as_float);
    for (const double at : {0.0, 0.6, 0.97}) {
        const auto progress = [&](double fraction, std::string_view) { return fraction < at; };
        try {
            pack_volume(volume, file("vol.esv"), {.progress = progress});
            ADD_FAILURE() << "was not stopped at " << at;
        } catch (const edgesplat::Error& error) {
            EXPECT_THAT(error.what(), HasSubstr("stopped"));
        }
        EXPECT_TRUE(std::filesystem::is_empty(folder_));
    }
    EXPECT_THROW(pack_volume(volume, file("no/such/folder/vol.esv")), edgesplat::Error);
}

/// Changes the file through HDF5.
void damage(const std::string& path, const std::function<void(hid_t file)>& change) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    change(file);
    ASSERT_GE(H5Fclose(file), 0);
}

void set_number(hid_t file, const char* name, std::uint64_t value) {
    const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_UINT64, &value);
    H5Aclose(attribute);
}

TEST_F(PackedVolumeTest, RefusesDamagedFilesByName) {
    const Volume volume = volume_of({67, 33, 41}, as_uint8);
    const std::string good = file("good.esv"), path = file("vol.esv");
    pack_volume(volume, good);
    const auto refusal_after = [&](const std::function<void(hid_t file)>& change) {
        std::filesystem::copy_file(good, path, std::filesystem::copy_options::overwrite_existing);
        damage(path, change);
        std::string text = volume_test::refusal(path);
        EXPECT_THAT(text, HasSubstr(path));
        return text;
    };
    EXPECT_THAT(refusal_after([](hid_t f) { set_number(f, "version", 3); }),
                HasSubstr("attribute version: 3, expected 1 to 2"));
    EXPECT_THAT(refusal_after([](hid_t f) { set_number(f, "labels", 3); }), HasSubstr("/labels/ids: missing"));
    EXPECT_THAT(refusal_after([](hid_t f) { H5Adelete(f, "warnings"); }), HasSubstr("attribute warnings: missing"));
    EXPECT_THAT(refusal_after([](hid_t f) { H5Adelete(f, "origin"); }), HasSubstr("attribute origin: missing"));
    EXPECT_THAT(refusal_after([](hid_t f) { H5Adelete(f, "checksum"); }), HasSubstr("attribute checksum: missing"));
    EXPECT_THAT(refusal_after([](hid_t f) { H5Ldelete(f, "/levels/1/samples", H5P_DEFAULT); }),
                HasSubstr("/levels/1/samples: missing"));
    EXPECT_THAT(refusal_after([](hid_t f) { H5Ldelete(f, "/levels/0/low", H5P_DEFAULT); }),
                HasSubstr("/levels/0/low: missing"));
    EXPECT_THAT(refusal_after([](hid_t f) { H5Ldelete(f, "/histogram", H5P_DEFAULT); }),
                HasSubstr("/histogram: missing"));
    const auto set_dims = [](std::array<std::int64_t, 3> dims) {
        return [dims](hid_t f) {
            const hid_t attribute = H5Aopen(f, "dims", H5P_DEFAULT);
            H5Awrite(attribute, H5T_NATIVE_INT64, dims.data());
            H5Aclose(attribute);
        };
    };
    EXPECT_THAT(refusal_after(set_dims({33, 67, 41})), HasSubstr("/levels/0/samples: 41 x 33 x 67"));
    EXPECT_THAT(refusal_after(set_dims({67, 33, 42})), HasSubstr("/histogram"));
    EXPECT_THAT(refusal_after(set_dims({0, 33, 41})), HasSubstr("attribute dims: 0"));
    EXPECT_THAT(refusal_after(set_dims({2000000, 1, 1})), HasSubstr("attribute dims: 2000000"));
    EXPECT_THAT(refusal_after(set_dims({1 << 20, 1 << 20, 2})), HasSubstr("2^40"));
    EXPECT_THAT(refusal_after([](hid_t f) {
                    const double axes[9] = {1, 0, 0, 2, 0, 0, 0, 0, 1};
                    const hid_t attribute = H5Aopen(f, "index_to_world_axes", H5P_DEFAULT);
                    H5Awrite(attribute, H5T_NATIVE_DOUBLE, axes);
                    H5Aclose(attribute);
                }),
                HasSubstr("axes lie in one plane"));
}

/// Boxes of three labels among others of number 0.
Volume labelled(const std::array<std::uint64_t, 4>& ids, bool is_signed, bool ranks) {
    auto table = std::make_shared<edgesplat::LabelTable>();
    table->is_signed = is_signed;
    for (std::size_t i = 0; i < ids.size(); ++i)
        table->labels.push_back(
            {ids[i], ranks ? static_cast<float>(i) : static_cast<float>(static_cast<std::int64_t>(ids[i])), {}, {}});
    table->labels[1].name = "Leber, \xc3\xbc";
    table->labels[1].color = glm::dvec3(0.25, 0.5, 1);
    Volume volume;
    volume.name = "made here";
    volume.stored_type = "int64";
    volume.geometry.dims = {70, 9, 8};
    for (int z = 0; z < 8; ++z)
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 70; ++x)
                volume.values.push_back(
                    table->labels[y < 2 || y > 6 ? 0U : 1 + static_cast<std::size_t>(x / 24)].value);
    volume.labels = std::move(table);
    volume.geometry_source = "sform (code 2)";
    volume.length_unit = "um";
    volume.warnings = {"Something was left out.", "Something else, too."};
    finish_volume(volume);
    return volume;
}

void expect_same_labels(const Volume& packed, const Volume& volume) {
    ASSERT_TRUE(packed.labels && volume.labels);
    EXPECT_EQ(packed.labels->is_signed, volume.labels->is_signed);
    ASSERT_EQ(packed.labels->labels.size(), volume.labels->labels.size());
    for (std::size_t i = 0; i < volume.labels->labels.size(); ++i) {
        const edgesplat::Label &found = packed.labels->labels[i], &wanted = volume.labels->labels[i];
        EXPECT_EQ(found.id, wanted.id);
        EXPECT_EQ(found.value, wanted.value);
        EXPECT_EQ(found.name, wanted.name);
        EXPECT_EQ(found.color, wanted.color);
    }
}

TEST_F(PackedVolumeTest, KeepsLabelsPlaceAndWarnings) {
    const std::uint64_t below = ~std::uint64_t{0};  // -1
    for (const Volume& volume :
         {labelled({0, 7, 300, 70000}, false, false), labelled({0, 997, 312782546, 1ULL << 63}, false, true),
          labelled({below, 0, 5, 6}, true, false), labelled({below, 0, 1, 1ULL << 40}, true, true)}) {
        pack_volume(volume, file("vol.esv"));
        const Volume packed = edgesplat::load_volume(file("vol.esv"));
        ASSERT_TRUE(packed.packed);
        expect_same_labels(packed, volume);
        EXPECT_EQ(packed.geometry_source, volume.geometry_source);
        EXPECT_EQ(packed.length_unit, volume.length_unit);
        EXPECT_EQ(packed.warnings, volume.warnings);
        EXPECT_EQ(packed.checksum, volume.checksum);
        EXPECT_EQ(packed.packed->label_voxels(), (std::vector<std::uint64_t>{2240, 960, 960, 880}));
        const Volume loaded = load_level(packed, 0);
        expect_same_labels(loaded, volume);
        EXPECT_EQ(loaded.values, volume.values);
        EXPECT_EQ(loaded.checksum, volume.checksum);
        EXPECT_EQ(loaded.warnings, volume.warnings);
        EXPECT_FALSE(load_level(packed, 1).labels);
    }
    pack_volume(labelled({0, 7, 300, 70000}, false, false), file("vol.esv"), {.quantise = 8});
    const Volume quantised = edgesplat::open_packed(file("vol.esv"));
    EXPECT_FALSE(quantised.labels);
    EXPECT_THAT(quantised.warnings, testing::Contains(HasSubstr("Its labels were left out")));
}

TEST_F(PackedVolumeTest, FindsLabelsInFilesThatAreReadPieceByPiece) {
    std::string voxels, large;
    for (int i = 0; i < 12 * 12 * 12; ++i) {
        const int x = i % 12, y = i / 12 % 12, z = i / 144;
        const bool in = x > 2 && x < 10 && y > 2 && y < 9 && z > 2 && z < 9;
        const std::int64_t id = !in ? 0 : x < 6 ? 1 : 312782546;
        voxels += static_cast<char>(!in ? 0 : x < 6 ? 1 : 2);
        large.append(reinterpret_cast<const char*>(&id), sizeof id);
    }
    const auto nrrd = [](const char* type, const std::string& bytes) {
        return fmt::format(
            "NRRD0004\ntype: {}\ndimension: 3\nsizes: 12 12 12\nspacings: 1 1 2\nendian: little\nencoding: raw\n\n{}",
            type, bytes);
    };
    for (const std::string& path :
         {write("small.nrrd", nrrd("uint8", voxels)), write("large.nrrd", nrrd("int64", large))}) {
        const Volume volume = edgesplat::load_volume(path);
        edgesplat::pack_file(path, {}, file("vol.esv"));
        const Volume packed = edgesplat::open_packed(file("vol.esv"));
        expect_same_labels(packed, volume);
        EXPECT_EQ(packed.checksum, volume.checksum);
        EXPECT_EQ(packed.geometry_source, volume.geometry_source);
        EXPECT_EQ(packed.notes, volume.notes);
    }
}

TEST_F(PackedVolumeTest, ReadsVersion1) {
    const std::string path = file("vol.esv");
    pack_volume(volume_of({67, 33, 41}, as_uint8), path);
    damage(path, [](hid_t f) {
        for (const char* name : {"labels", "labels_signed", "geometry_source", "length_unit", "warnings"})
            H5Adelete(f, name);
        set_number(f, "version", 1);
    });
    const Volume volume = edgesplat::load_volume(path);
    EXPECT_EQ(volume.notes.size(), 2U);
    EXPECT_TRUE(volume.geometry_source.empty());
    EXPECT_FALSE(volume.labels);
}

TEST_F(PackedVolumeTest, RefusesContradictoryLabels) {
    const std::string good = file("good.esv"), path = file("vol.esv");
    pack_volume(labelled({0, 7, 300, 70000}, false, false), good);
    const auto refusal_after = [&](const std::function<void(hid_t file)>& change) {
        std::filesystem::copy_file(good, path, std::filesystem::copy_options::overwrite_existing);
        damage(path, change);
        return volume_test::refusal(path);
    };
    const auto write_rows = [](const char* name, hid_t type, const auto& rows) {
        return [=](hid_t f) {
            const hid_t dataset = H5Dopen2(f, name, H5P_DEFAULT);
            ASSERT_GE(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), 0);
            H5Dclose(dataset);
        };
    };
    using Rows = std::array<std::uint64_t, 4>;
    EXPECT_THAT(refusal_after([](hid_t f) { set_number(f, "labels", 5); }), HasSubstr("/labels/ids: 4"));
    EXPECT_THAT(refusal_after([](hid_t f) { set_number(f, "labels", std::uint64_t{1} << 60); }),
                HasSubstr("attribute labels: 1152921504606846976, expected at most 1048576"));
    EXPECT_THAT(refusal_after(write_rows("/labels/ids", H5T_NATIVE_UINT64, Rows{0, 300, 7, 70000})),
                HasSubstr("/labels/ids: 300 before 7, expected ascending numbers"));
    EXPECT_THAT(refusal_after(write_rows("/labels/voxels", H5T_NATIVE_UINT64, Rows{2240, 960, 960, 881})),
                HasSubstr("/labels/voxels: more than the 5040 voxels with data"));
    EXPECT_THAT(refusal_after(write_rows("/labels/voxels", H5T_NATIVE_UINT64, Rows{2240, 960, 960, 0})),
                HasSubstr("/labels/voxels: 4160 voxels in all, expected 5040"));
    EXPECT_THAT(refusal_after(write_rows("/labels/colors", H5T_NATIVE_DOUBLE, std::array<double, 12>{0, 0, 2})),
                HasSubstr("/labels/colors: 2 of label 0, expected 0 to 1"));
    EXPECT_THAT(refusal_after(write_rows("/labels/names", H5T_NATIVE_UINT8, std::array<unsigned char, 16>{})),
                HasSubstr("/labels/names: 13 names that end with a zero byte, expected 4"));
    EXPECT_THAT(refusal_after([](hid_t f) { H5Ldelete(f, "/labels/colors", H5P_DEFAULT); }),
                HasSubstr("/labels/colors: missing"));
    // A sample of another number is found when the samples are read.
    std::filesystem::copy_file(good, path, std::filesystem::copy_options::overwrite_existing);
    damage(path, write_rows("/labels/ids", H5T_NATIVE_UINT64, Rows{0, 7, 301, 70000}));
    try {
        (void)load_level(edgesplat::open_packed(path), 0);
        ADD_FAILURE() << "was read";
    } catch (const edgesplat::Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("a sample is 300, which is none of its 4 labels"));
    }
}

TEST_F(PackedVolumeTest, RefusesTruncatedAndForeignFiles) {
    const std::string path = file("vol.esv");
    pack_volume(volume_of({67, 33, 41}, as_uint8), path);
    const std::string content = volume_test::content_of(path);
    for (const double share : {0.02, 0.3, 0.9, 0.999}) {
        const auto cut = static_cast<std::size_t>(share * static_cast<double>(content.size()));
        EXPECT_THAT(volume_test::refusal(write("cut.esv", content.substr(0, cut))), HasSubstr("truncated")) << share;
    }
    EXPECT_THAT(volume_test::refusal(write("text.esv", "not HDF5 at all")), HasSubstr("unknown volume format"));
    const hid_t foreign = H5Fcreate(file("other.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    ASSERT_GE(H5Fclose(foreign), 0);
    EXPECT_THAT(volume_test::refusal(file("other.h5")), HasSubstr("contains no array of numbers"));
    EXPECT_THAT(volume_test::refusal(path, {.spacing = glm::dvec3(1)}), HasSubstr("--spacing"));
    EXPECT_THAT(volume_test::refusal(path, {.component = 1}), HasSubstr("--component"));
}

TEST_F(PackedVolumeTest, ReportsDamagedBricks) {
    const std::string path = file("vol.esv");
    pack_volume(volume_of({67, 33, 41}, as_uint16), path, {.compress = true});
    const hid_t stored = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t samples = H5Dopen2(stored, "/levels/0/samples", H5P_DEFAULT);
    const hsize_t first[3]{};
    hsize_t size = 0;
    unsigned filters = 0;
    haddr_t begin = 0;
    ASSERT_GE(H5Dget_chunk_info_by_coord(samples, first, &filters, &begin, &size), 0);
    H5Dclose(samples);
    H5Fclose(stored);
    std::string content = volume_test::content_of(path);
    for (std::size_t i = begin; i < begin + size; ++i)
        content[i] = static_cast<char>(~content[i]);
    write("broken.esv", content);
    const auto packed = PackedVolume::open(file("broken.esv"));
    std::vector<float> values(packed->geometry(0).voxel_count());
    try {
        packed->read(0, glm::ivec3(0), packed->geometry(0).dims, values);
        ADD_FAILURE() << "the damaged brick was read";
    } catch (const edgesplat::Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("/levels/0/samples: cannot be read"));
    }
}

TEST_F(PackedVolumeTest, RefusesFiltersThatNeedAllSamples) {
    pack_volume(volume_of({67, 33, 41}, as_uint16), file("vol.esv"));
    const Volume opened = edgesplat::open_packed(file("vol.esv"));
    for (const auto& work : std::vector<std::function<void()>>{
             [&] { (void)box_filter(opened); }, [&] { (void)threshold(opened, 1); },
             [&] { (void)cropped(opened, glm::ivec3(0), glm::ivec3(3)); }, [&] { (void)scaled_field(opened); },
             [&] { (void)pack_volume(opened, file("again.esv")); }}) {
        try {
            work();
            ADD_FAILURE() << "no error";
        } catch (const edgesplat::Error& error) {
            EXPECT_THAT(error.what(), HasSubstr("needs all samples in memory"));
        }
    }
}

TEST_F(PackedVolumeTest, ReadsHistogramAndSuggestionsFromFile) {
    const Volume volume = edgesplat::load_volume("builtin:phantom:80");
    edgesplat::pack_file("builtin:phantom:80", {}, file("vol.esv"));
    const Volume opened = edgesplat::open_packed(file("vol.esv"));
    const auto all = edgesplat::histogram(volume, 64), packed = edgesplat::histogram(opened, 64);
    EXPECT_EQ(packed.counts, all.counts);
    const auto wanted = suggest_iso_values(volume), found = suggest_iso_values(opened);
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i)
        EXPECT_EQ(found[i].value, wanted[i].value);
}

}  // namespace
