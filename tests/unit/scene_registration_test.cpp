// Results of registrations, written by ITK: the matrix that is read moves points as ITK does.
#include "engine/volume/itk_transform.h"

#include <gmock/gmock.h>
#include <itkAffineTransform.h>
#include <itkBSplineTransform.h>
#include <itkCompositeTransform.h>
#include <itkEuler3DTransform.h>
#include <itkHDF5TransformIOFactory.h>
#include <itkIdentityTransform.h>
#include <itkMatlabTransformIOFactory.h>
#include <itkSimilarity3DTransform.h>
#include <itkTransformFileWriter.h>
#include <itkTranslationTransform.h>
#include <itkTxtTransformIOFactory.h>
#include <itkVersorRigid3DTransform.h>
#include <unistd.h>

#include <fstream>

#include "engine/scene/scene_document.h"
#include "tests/unit/refusal.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using Transform = itk::Transform<double, 3, 3>;

class ItkTransforms : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        itk::TxtTransformIOFactory::RegisterOneFactory();
        itk::HDF5TransformIOFactory::RegisterOneFactory();
        itk::MatlabTransformIOFactory::RegisterOneFactory();
    }
    void SetUp() override { fs::create_directories(folder_); }
    void TearDown() override { fs::remove_all(folder_); }

    std::string written(const Transform* transform, const std::string& name) const {
        const std::string path = folder_ / name;
        const auto writer = itk::TransformFileWriterTemplate<double>::New();
        writer->SetInput(transform);
        writer->SetFileName(path);
        writer->Update();
        return path;
    }
    std::string written(const std::string& text, const std::string& name = "a.tfm") const {
        const std::string path = folder_ / name;
        std::ofstream(path) << text;
        return path;
    }
    static std::string refused(const std::string& path) {
        return refusal([&] { read_itk_transform(path); });
    }
    /// Writes it in every format that holds it, and compares points.
    void expect_same_points(const Transform* transform, const std::string& what, bool in_matlab = true) const {
        for (const char* name : {"a.tfm", "b.txt", "c.h5", "d.mat"}) {
            if (!in_matlab && std::string(name) == "d.mat") continue;
            SCOPED_TRACE(what + " in " + name);
            const glm::dmat4 matrix = read_itk_transform(written(transform, name));
            for (const glm::dvec3& at : {glm::dvec3(0), glm::dvec3(10, -20, 35), glm::dvec3(-71, 3, 8)}) {
                const auto moved = transform->TransformPoint(Transform::InputPointType(&at.x));
                const glm::dvec4 got = matrix * glm::dvec4(at, 1);
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_NEAR(got[axis], moved[static_cast<unsigned>(axis)], 1e-9);
            }
        }
    }

    const fs::path folder_ = fs::temp_directory_path() / ("edgesplat_itk_transforms." + std::to_string(getpid()));
};

template <typename Kind>
void set_center(Kind& transform) {
    const double center[3] = {4, -7, 12};
    transform.SetCenter(typename Kind::InputPointType(center));
    const double shift[3] = {1.5, 20, -3};
    transform.SetTranslation(typename Kind::OutputVectorType(shift));
}

itk::VersorRigid3DTransform<double>::Pointer turned() {
    const auto rigid = itk::VersorRigid3DTransform<double>::New();
    itk::Vector<double, 3> axis;
    axis[0] = 0.3;
    axis[1] = -1;
    axis[2] = 0.6;
    rigid->SetRotation(axis, 2.2);
    set_center(*rigid);
    return rigid;
}

itk::AffineTransform<double, 3>::Pointer sheared() {
    const auto affine = itk::AffineTransform<double, 3>::New();
    itk::Matrix<double, 3, 3> matrix;
    const double rows[3][3] = {{1.1, 0.2, -0.3}, {0.05, 0.9, 0.1}, {-0.2, 0.4, 1.3}};
    for (unsigned i = 0; i < 3; ++i)
        for (unsigned j = 0; j < 3; ++j)
            matrix(i, j) = rows[i][j];
    affine->SetMatrix(matrix);
    set_center(*affine);
    return affine;
}

TEST_F(ItkTransforms, MovePointsAsItkDoes) {
    expect_same_points(itk::IdentityTransform<double, 3>::New(), "identity", false);
    const auto shift = itk::TranslationTransform<double, 3>::New();
    const double by[3] = {3, -4, 5};
    shift->SetOffset(itk::Vector<double, 3>(by));
    expect_same_points(shift, "translation", false);
    expect_same_points(turned(), "versor");
    expect_same_points(sheared(), "affine");
    for (const bool zyx : {false, true}) {
        const auto euler = itk::Euler3DTransform<double>::New();
        euler->SetComputeZYX(zyx);
        euler->SetRotation(0.4, -0.9, 1.7);
        set_center(*euler);
        expect_same_points(euler, zyx ? "Euler, ZYX" : "Euler, ZXY");
    }
    const auto similar = itk::Similarity3DTransform<double>::New();
    similar->SetMatrix(turned()->GetMatrix());
    similar->SetScale(1.7);
    set_center(*similar);
    expect_same_points(similar, "similarity");
    const auto composite = itk::CompositeTransform<double, 3>::New();
    composite->AddTransform(turned());
    composite->AddTransform(sheared());
    composite->AddTransform(shift);
    expect_same_points(composite, "composite", false);
}

TEST_F(ItkTransforms, ThatBendAreRefusedByName) {
    const auto bending = itk::BSplineTransform<double, 3, 3>::New();
    EXPECT_THAT(refused(written(bending, "a.tfm")),
                AllOf(HasSubstr("a.tfm"), HasSubstr("BSplineTransform"), HasSubstr("expected a rigid or affine")));
    const auto composite = itk::CompositeTransform<double, 3>::New();
    composite->AddTransform(turned());
    composite->AddTransform(bending);
    EXPECT_THAT(refused(written(composite, "b.h5")), HasSubstr("BSplineTransform"));
}

TEST_F(ItkTransforms, AreCheckedFieldByField) {
    const std::string head = "#Insight Transform File V1.0\n#Transform 0\n";
    const std::string affine = "Transform: AffineTransform_double_3_3\n";
    EXPECT_THAT(refused(folder_ / "none.tfm"), HasSubstr("none.tfm: cannot be read"));
    EXPECT_THAT(refused(written("12345678 no transform\n")), HasSubstr("Transform: TYPE"));
    EXPECT_THAT(refused(written(head + affine + "Parameters: 1 0 0 0 1\n")), HasSubstr("5 parameters, expected 12"));
    EXPECT_THAT(refused(written(head + affine + "Parameters: 1 0 0 0 one 0 0 0 1 0 0 0\n")),
                AllOf(HasSubstr("Parameters"), HasSubstr("'one'")));
    EXPECT_THAT(refused(written(head + affine + "Parameters: 1 0 0 0 1 0 0 0 1 nan 0 0\n")), HasSubstr("'nan'"));
    EXPECT_THAT(refused(written(head + affine + "Parameters: 1 0 0 0 1 0 0 0 0 5 0 0\n")),
                HasSubstr("that can be inverted"));
    EXPECT_THAT(refused(written(head + "Transform: Euler2DTransform_double_2_2\nParameters: 0 0 0\n")),
                HasSubstr("three dimensions"));
    const std::string one = affine + "Parameters: 1 0 0 0 1 0 0 0 1 5 0 0\nFixedParameters: 0 0 0\n";
    EXPECT_THAT(refused(written(head + one + one)), HasSubstr("2 transforms, expected one"));
    const std::string whole = written(turned(), "a.mat");
    fs::resize_file(whole, fs::file_size(whole) - 9);
    EXPECT_THAT(refused(whole), HasSubstr("truncated"));
}

/// A registration maps fixed points to moving ones: a voxel of the moving image comes to lie where its fixed point is.
TEST_F(ItkTransforms, PlaceTheMovingImageOnTheFixedOne) {
    const auto affine = sheared();
    VolumeSource source;
    source.path = "builtin:sphere:8";
    const Volume before = read_source(source, {});
    source.registration = written(affine, "a.tfm");
    const Volume after = read_source(source, {});
    for (const glm::dvec3& voxel : {glm::dvec3(0), glm::dvec3(1, 2, 3), glm::dvec3(7, 0, 5)}) {
        const glm::dvec3 fixed = after.geometry.to_world(voxel);
        const auto moving = affine->TransformPoint(Transform::InputPointType(&fixed.x));
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(before.geometry.to_world(voxel)[axis], moving[static_cast<unsigned>(axis)], 1e-9);
    }
}

}  // namespace
}  // namespace edgesplat
