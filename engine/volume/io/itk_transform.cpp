#include "engine/volume/itk_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "engine/volume/io/hdf5.h"

namespace edgesplat {
namespace {

using Numbers = std::vector<double>;

/// One transform of a file: its ITK name without precision and dimensions, and its numbers.
struct StoredTransform {
    std::string type;
    Numbers parameters, fixed;
};

constexpr std::size_t kMostNumbers = 64;  // of a linear transform; others are refused before their numbers matter
constexpr std::size_t kMostTransforms = 256;

/// "AffineTransform" of "AffineTransform_double_3_3".
std::string name_of_type(const std::string& path, const std::string& type) {
    const std::size_t end = type.find('_');
    if (end != std::string::npos && !type.ends_with("_3_3"))
        fail("{}: {}: expected a transform of three dimensions", path, type);
    return type.substr(0, end);
}

Numbers numbers_of(const std::string& path, const std::string& field, std::istringstream& text) {
    Numbers numbers;
    for (std::string word; text >> word;) {
        std::size_t used = 0;
        double value = NAN;
        try {
            value = std::stod(word, &used);
        } catch (const std::exception&) {
            used = 0;
        }
        if (used != word.size() || !std::isfinite(value))
            fail("{}: {}: '{}' is not a finite number", path, field, word);
        if (numbers.size() < kMostNumbers) numbers.push_back(value);
    }
    return numbers;
}

/// "Key: values" in each line; "Transform" begins the next one.
std::vector<StoredTransform> transforms_of_text(const std::string& path) {
    std::ifstream file(path);
    std::vector<StoredTransform> found;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#')) continue;
        const std::size_t colon = line.find(':');
        if (colon == std::string::npos) continue;
        const std::string field = line.substr(0, colon);
        std::istringstream rest(line.substr(colon + 1));
        if (field == "Transform") {
            std::string type;
            rest >> type;
            found.push_back({name_of_type(path, type), {}, {}});
            if (found.size() > kMostTransforms) fail("{}: expected at most {} transforms", path, kMostTransforms);
        } else if (!found.empty() && (field == "Parameters" || field == "FixedParameters")) {
            (field == "Parameters" ? found.back().parameters : found.back().fixed) = numbers_of(path, field, rest);
        }
    }
    if (found.empty()) fail("{}: expected a line `Transform: TYPE` of an ITK transform file", path);
    return found;
}

std::vector<StoredTransform> transforms_of_hdf5(const std::string& path) {
    const std::lock_guard lock(detail::hdf5_mutex());
    const detail::Hdf5File file = detail::Hdf5File::open(path);
    std::vector<StoredTransform> found;
    for (std::size_t number = 0; number < kMostTransforms; ++number) {
        const std::string group = fmt::format("/TransformGroup/{}/", number);
        if (!file.has(group + "TransformType")) break;
        const auto numbers = [&](std::initializer_list<const char*> names) {
            Numbers read;
            for (const char* name : names) {
                if (!file.has(group + name)) continue;
                const detail::Hdf5Dataset data = file.dataset(group + name);
                if (data.extent().size() != 1) fail("{}: {}{}: expected a list of numbers", path, group, name);
                read.resize(std::min<std::uint64_t>(data.extent()[0], kMostNumbers));
                if (!read.empty()) data.read({0}, {read.size()}, detail::SampleType::Float64, read.data());
            }
            return read;
        };
        // Old files misspell the names.
        found.push_back({name_of_type(path, file.text_dataset(group + "TransformType")),
                         numbers({"TransformParameters", "TranformParameters"}),
                         numbers({"TransformFixedParameters", "TranformFixedParameters"})});
    }
    if (found.empty()) fail("{}: /TransformGroup/0/TransformType: missing; expected an ITK transform file", path);
    return found;
}

/// MATLAB 4: the parameters as a matrix with the type as its name, then the matrix "fixed".
std::vector<StoredTransform> transforms_of_matlab(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<StoredTransform> found;
    std::array<std::int32_t, 5> header{};  // type, rows, columns, imaginary part, length of the name
    while (file.read(reinterpret_cast<char*>(header.data()), sizeof(header))) {
        const auto [type, rows, columns, imaginary, length] = header;
        const bool doubles = type == 0, floats = type == 10;
        if (!(doubles || floats) || rows < 0 || columns != 1 || imaginary != 0 || length < 1 || length > 256)
            fail("{}: expected matrices of one column in MATLAB's format 4, little endian", path);
        std::string name(static_cast<std::size_t>(length), '\0');
        file.read(name.data(), length);
        name.resize(std::min(name.find('\0'), name.size()));
        Numbers numbers;
        for (std::int32_t row = 0; file && row < rows; ++row) {
            double value = 0;
            float single = 0;
            if (doubles)
                file.read(reinterpret_cast<char*>(&value), sizeof(value));
            else
                file.read(reinterpret_cast<char*>(&single), sizeof(single));
            if (!doubles) value = static_cast<double>(single);
            if (!std::isfinite(value)) fail("{}: {}: expected finite numbers", path, name);
            if (numbers.size() < kMostNumbers) numbers.push_back(value);
        }
        if (!file) fail("{}: truncated", path);
        if (name == "fixed" && !found.empty())
            found.back().fixed = numbers;
        else
            found.push_back({name_of_type(path, name), numbers, {}});
        if (found.size() > kMostTransforms) fail("{}: expected at most {} transforms", path, kMostTransforms);
    }
    if (found.empty()) fail("{}: expected an ITK transform file", path);
    return found;
}

/// The rotation of a unit quaternion's vector part.
glm::dmat3 rotation_of_versor(const glm::dvec3& v) {
    const double w = std::sqrt(std::max(1 - glm::dot(v, v), 0.0));
    const glm::dmat3 across(glm::dvec3(0, v.z, -v.y), glm::dvec3(-v.z, 0, v.x), glm::dvec3(v.y, -v.x, 0));
    return glm::dmat3(1) + 2.0 * w * across + 2.0 * across * across;
}

glm::dmat3 rotation_about(int axis, double angle) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    glm::dmat3 m(1);
    m[next][next] = m[last][last] = std::cos(angle);
    m[next][last] = std::sin(angle);
    m[last][next] = -std::sin(angle);
    return m;
}

glm::dvec3 three(const Numbers& numbers, std::size_t from) {
    return {numbers[from], numbers[from + 1], numbers[from + 2]};
}

/// The classes of ITK, itkXTransform.h: x is moved to M (x - center) + center + translation.
glm::dmat4 matrix_of(const std::string& path, const StoredTransform& stored) {
    const Numbers& p = stored.parameters;
    const auto need = [&](std::size_t count) {
        if (p.size() != count) fail("{}: {} has {} parameters, expected {}", path, stored.type, p.size(), count);
    };
    glm::dmat3 m(1);
    glm::dvec3 translation(0);
    const std::string& type = stored.type;
    if (type == "AffineTransform" || type == "MatrixOffsetTransformBase" || type == "Rigid3DTransform") {
        need(12);
        m = glm::transpose(glm::dmat3(three(p, 0), three(p, 3), three(p, 6)));
        translation = three(p, 9);
    } else if (type == "Euler3DTransform") {
        need(6);
        const glm::dmat3 x = rotation_about(0, p[0]), y = rotation_about(1, p[1]), z = rotation_about(2, p[2]);
        const bool zyx = stored.fixed.size() > 3 && stored.fixed[3] != 0;
        m = zyx ? z * y * x : z * x * y;
        translation = three(p, 3);
    } else if (type == "VersorRigid3DTransform") {
        need(6);
        m = rotation_of_versor(three(p, 0));
        translation = three(p, 3);
    } else if (type == "Similarity3DTransform") {
        need(7);
        m = p[6] * rotation_of_versor(three(p, 0));
        translation = three(p, 3);
    } else if (type == "VersorTransform") {
        need(3);
        m = rotation_of_versor(three(p, 0));
    } else if (type == "TranslationTransform") {
        need(3);
        translation = three(p, 0);
    } else if (type != "IdentityTransform") {
        fail(
            "{}: {} is not supported, expected a rigid or affine transform; resample the volume with the program that "
            "made it",
            path, type);
    }
    const glm::dvec3 center =
        stored.fixed.size() >= 3 && type != "TranslationTransform" ? three(stored.fixed, 0) : glm::dvec3(0);
    glm::dmat4 out(m);
    out[3] = glm::dvec4(center + translation - m * center, 1);
    return out;
}

}  // namespace

glm::dmat4 read_itk_transform(const std::filesystem::path& path) {
    const std::string name = path.string();
    std::array<char, 8> first{};
    std::ifstream file(path, std::ios::binary);
    if (!file.read(first.data(), first.size())) fail("{}: cannot be read, or is too short for a transform", name);
    file.close();
    const bool matlab = first[0] == 0 || first[0] == 10;
    std::vector<StoredTransform> stored = std::string_view(first.data(), first.size()) == detail::kHdf5Signature
                                              ? transforms_of_hdf5(name)
                                          : matlab ? transforms_of_matlab(name)
                                                   : transforms_of_text(name);
    const bool composite = stored.front().type == "CompositeTransform";
    if (composite) stored.erase(stored.begin());
    if (stored.empty() || (stored.size() > 1 && !composite))
        fail("{}: {} transforms, expected one, or a CompositeTransform", name, stored.size());
    // The last of a composite is applied first.
    glm::dmat4 matrix(1);
    for (const StoredTransform& one : stored)
        matrix = matrix * matrix_of(name, one);
    const double volume = glm::determinant(matrix);
    if (!std::isfinite(volume) || volume == 0) fail("{}: expected a transform that can be inverted", name);
    return matrix;
}

}  // namespace edgesplat
