// Tools for splats and clouds, against values derived on paper.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/geometry/place.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/geometry/sample.h"
#include "easypbr/geometry/surfels.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::splats_test {
namespace {

constexpr float constant = 0.28209479f;

/// Splats along x at 0, 1, 2, ..., all alike but for their labels.
MeshData row_of_splats(int count) {
    Array3f::Dense V = Array3f::Dense::Zero(count, 3), scales(count, 3);
    Array4f::Dense rotations = Array4f::Dense::Zero(count, 4);
    Array1i::Dense L(count);
    for (int i = 0; i < count; ++i) {
        V(i, 0) = float(i);
        scales.row(i) << 0.1f, 0.2f, 0.3f;
        rotations(i, 0) = 1;
        L(i) = i;
    }
    MeshData mesh;
    mesh.name = "row";
    mesh.V = std::move(V);
    mesh.L = Array1i(std::move(L));
    mesh.splats = {std::move(scales), std::move(rotations), Array1f::Dense::Constant(count, 0.5f),
                   ArrayXf::Dense::Zero(count, 12)};
    return mesh;
}

std::vector<int> labels(const Mesh& mesh) {
    const auto data = mesh.snapshot();
    return {data->L.data(), data->L.data() + data->L.size()};
}

using Labels = std::vector<int>;

TEST(SplatTools, CropsByMeans) {
    MeshData data = row_of_splats(6);
    const Box3d box(Vec3d(1, -1, -1), Vec3d(3, 1, 1));
    EXPECT_EQ(labels(crop_box(Mesh(data), box)), Labels({1, 2, 3}));
    EXPECT_EQ(labels(crop_box(Mesh(data), box, Keep::outside)), Labels({0, 4, 5}));
    EXPECT_EQ(labels(crop_sphere(Mesh(data), Vec3d(4, 0, 0), 1)), Labels({3, 4, 5}));
    EXPECT_EQ(labels(crop_sphere(Mesh(data), Vec3d(4, 0, 0), 1, Keep::outside)), Labels({0, 1, 2}));
    data.offset = Vec3d(100, 0, 0);
    EXPECT_EQ(labels(crop_sphere(Mesh(data), Vec3d(102, 0, 0), 0.5)), Labels({2}));
    validate(*crop_box(Mesh(data), Box3d(Vec3d(99, -1, -1), Vec3d(101, 1, 1))).snapshot());
}

TEST(SplatTools, CropsFacesWhoseVerticesAllStay) {
    // 4 x 4 quads from -1 to 1: half of them have 5 x 3 vertices and 4 x 2 quads.
    const Mesh half = crop_box(make_plane(2, 4), Box3d(Vec3d(-2, -2, -2), Vec3d(0, 2, 2)));
    EXPECT_EQ(half.V().rows(), 15);
    EXPECT_EQ(half.F().rows(), 16);
}

TEST(SplatTools, PrunesByOpacityAndSize) {
    MeshData data = row_of_splats(4);
    Array1f::Dense opacities(4);
    opacities << 0.01f, 0.2f, 0.5f, 0.9f;
    Array3f::Dense scales = data.splats.scales;
    scales(3, 1) = 5;
    data.splats.opacities = std::move(opacities);
    data.splats.scales = std::move(scales);
    EXPECT_EQ(labels(prune_splats(Mesh(data), {.least_opacity = 0.4})), Labels({2, 3}));
    EXPECT_EQ(labels(prune_splats(Mesh(data), {.most_size = 1})), Labels({0, 1, 2}));
    EXPECT_EQ(labels(prune_splats(Mesh(data), {.least_size = 1})), Labels({3}));
}

TEST(SplatTools, MergesTwoByTheirMoments) {
    MeshData data = row_of_splats(2);
    const auto merged = decimate_splats(Mesh(data), 1).snapshot();
    ASSERT_EQ(merged->V.rows(), 1);
    EXPECT_NEAR(merged->V(0, 0), 0.5, 1e-6);
    // Variances 0.01, 0.04, 0.09, and along x 1/4 for the distance of 1.
    const double axes[] = {std::sqrt(0.04), std::sqrt(0.09), std::sqrt(0.01 + 0.25)};
    Eigen::RowVector3f scales = merged->splats.scales.row(0);
    std::sort(scales.begin(), scales.end());
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(scales[k], axes[k], 1e-6);
    const auto area = [](double a, double b, double c) { return a * b + b * c + c * a; };
    EXPECT_NEAR(merged->splats.opacities(0), 2 * 0.5 * area(0.1, 0.2, 0.3) / area(axes[0], axes[1], axes[2]),
                1e-6);
    EXPECT_EQ(merged->splats.degree(), 1);
    validate(*merged);
}

TEST(SplatTools, DecimatesToTheNumberAsked) {
    const MeshData data = row_of_splats(1000);
    for (const int count : {1, 7, 499, 500, 999, 1000, 2000}) {
        const Mesh fewer = decimate_splats(Mesh(data), count);
        EXPECT_EQ(fewer.V().rows(), std::min(count, 1000));
        validate(*fewer.snapshot());
    }
    // Those of one colour are merged first: of pairs of black and white only equal neighbours.
    MeshData colored = row_of_splats(8);
    ArrayXf::Dense sh = ArrayXf::Dense::Zero(8, 3);
    for (int i = 2; i < 4; ++i) sh.row(i).setConstant(5);
    for (int i = 6; i < 8; ++i) sh.row(i).setConstant(5);
    colored.splats.sh = std::move(sh);
    const auto four = decimate_splats(Mesh(colored), 6).snapshot();
    for (int i = 0; i < 6; ++i) {
        const float color = four->splats.sh(i, 0);
        EXPECT_TRUE(color == 0 || color == 5) << color;
    }
}

TEST(SplatTools, CloudsAndSurfelsHaveTheirColors) {
    MeshData data = row_of_splats(3);
    ArrayXf::Dense sh = data.splats.sh;
    sh(1, 0) = 0.25f / constant;
    sh(2, 2) = 9;
    data.splats.sh = std::move(sh);
    // The shortest axis, x, points along z: a quarter turn about y.
    Array4f::Dense rotations = data.splats.rotations;
    rotations.row(1) << std::sqrt(0.5f), 0, std::sqrt(0.5f), 0;
    data.splats.rotations = std::move(rotations);
    const auto cloud = cloud_from_splats(Mesh(data)).snapshot();
    EXPECT_TRUE(cloud->splats.empty());
    EXPECT_LE((cloud->C.row(1) - Eigen::RowVector4f(0.75f, 0.5f, 0.5f, 0.5f)).cwiseAbs().maxCoeff(), 1e-6f);
    EXPECT_EQ(cloud->C(2, 2), 1);
    const auto surfels = surfels_from_splats(Mesh(data)).snapshot();
    EXPECT_TRUE(surfels->splats.empty());
    EXPECT_EQ(surfels->C, cloud->C);
    const float two = std::sqrt(2.0f);
    EXPECT_NEAR(std::abs(surfels->N(0, 0)), 1, 1e-6);
    EXPECT_NEAR(std::abs(surfels->N(1, 2)), 1, 1e-6);
    EXPECT_NEAR(std::abs(surfels->T(0, 2)), two * 0.3f, 1e-6);
    EXPECT_NEAR(std::abs(surfels->T(1, 0)), two * 0.3f, 1e-6);
    EXPECT_NEAR(surfels->B(0), two * 0.2f, 1e-6);
    validate(*surfels);
}

std::string message_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const ArgumentError& error) {
        return error.what();
    }
    return {};
}

TEST(SplatTools, SayWhatIsWrong) {
    const Mesh splats(row_of_splats(2)), box = make_box();
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    EXPECT_TRUE(has(message_of([&] { prune_splats(box, {}); }), "mesh with splats"));
    EXPECT_TRUE(has(message_of([&] { decimate_splats(box, 1); }), "mesh with splats"));
    EXPECT_TRUE(has(message_of([&] { decimate_splats(splats, 0); }), "1 or more"));
    EXPECT_TRUE(has(message_of([&] { cloud_from_splats(box); }), "mesh with splats"));
    EXPECT_TRUE(has(message_of([&] { surfels_from_splats(box); }), "mesh with splats"));
    EXPECT_TRUE(has(message_of([&] { prune_splats(splats, {.least_opacity = 2}); }), "nothing stays"));
    EXPECT_TRUE(has(message_of([&] { prune_splats(splats, {.least_size = std::nan("")}); }), "numbers"));
    EXPECT_TRUE(has(message_of([&] { crop_sphere(splats, Vec3d(0, 0, 0), 0); }),
                    "crop_sphere: expected a finite centre and a radius > 0, got 0,0,0,0"));
    EXPECT_TRUE(has(message_of([&] { crop_box(splats, Box3d(Vec3d(1, 0, 0), Vec3d(0, 1, 1))); }),
                    "lowest corner is below its highest, got 1,0,0,0,1,1"));
    EXPECT_TRUE(
        has(message_of([&] { crop_box(splats, Box3d(Vec3d(8, 0, 0), Vec3d(9, 1, 1))); }), "nothing stays"));
}

}  // namespace
}  // namespace easypbr::splats_test
