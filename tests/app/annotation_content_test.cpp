// Which legends and colour bars annotations of a scene have.
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/app/annotation.h"
#include "easypbr/scene/label_colors.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::annotation_content_test {

TEST(Annotation, NamesWhatOccurs) {
    SceneSnapshot scene;
    MeshData cloud;
    cloud.V = Array3f(Array3f::Dense::Zero(4, 3));
    cloud.L = Array1i(Array1i::Dense{{50}, {10}, {-7}, {10}});
    cloud.label_map = built_in_label_map("semantic_kitti");
    MeshData values;
    values.V = Array3f(Array3f::Dense::Zero(3, 3));
    values.scalars = {
        {"t", Array1f(Array1f::Dense{{0.0f}, {3.0f}, {std::numeric_limits<float>::quiet_NaN()}})}};
    for (const MeshData& mesh : {cloud, values, values})
        scene.objects.push_back({"m", std::make_shared<const MeshData>(mesh), Eigen::Affine3d::Identity()});
    InferredSettings settings;
    settings.camera.up = "+y";
    EXPECT_TRUE(annotation_of(scene, settings).empty()) << "nobody asked";
    settings.annotation.legend = true;
    settings.annotation.colorbar = true;
    const Annotation found = annotation_of(scene, settings);
    ASSERT_EQ(found.legends.size(), 1u);
    EXPECT_EQ(found.legends[0].entries,
              (std::vector<LegendEntry>{
                  {"unlabeled", {0, 0, 0}}, {"car", {100, 150, 245}}, {"building", {255, 200, 0}}}));
    ASSERT_EQ(found.bars.size(), 1u) << "equal bars are one";
    EXPECT_EQ(found.bars[0].title, "t");
    EXPECT_EQ(found.bars[0].range.max, 3);
    EXPECT_TRUE(found.bars[0].nan_color);
    settings.style.visible = false;
    EXPECT_TRUE(annotation_of(scene, settings).empty());
}

TEST(Annotation, BarsOfTheSameTitleNameTheirObjects) {
    const auto mesh_to = [](float largest) {
        MeshData mesh;
        mesh.V = Array3f(Array3f::Dense::Zero(2, 3));
        mesh.scalars = {{"error", Array1f(Array1f::Dense{{0.0f}, {largest}})}};
        return std::make_shared<const MeshData>(mesh);
    };
    SceneSnapshot scene;
    const auto titles = [&] {
        InferredSettings settings;
        settings.camera.up = "+y";
        settings.annotation.colorbar = true;
        std::vector<std::string> result;
        for (const ColorBar& bar : annotation_of(scene, settings).bars) result.push_back(bar.title);
        return result;
    };
    using Titles = std::vector<std::string>;
    scene.objects.push_back({"ours", mesh_to(1), Eigen::Affine3d::Identity()});
    scene.objects.push_back({"again", mesh_to(1), Eigen::Affine3d::Identity()});
    EXPECT_EQ(titles(), (Titles{"error"})) << "one bar for equal colours of equal values";
    scene.objects.push_back({"theirs", mesh_to(10), Eigen::Affine3d::Identity()});
    EXPECT_EQ(titles(), (Titles{"error (ours + 1 more)", "error (theirs)"}));
    scene.objects.erase(scene.objects.begin() + 1);
    EXPECT_EQ(titles(), (Titles{"error (ours)", "error (theirs)"}));
}

TEST(Annotation, BarsOfObjectsOfTheSameNameHaveNumbers) {
    SceneSnapshot scene;
    const auto add = [&](const char* name, float largest) {
        MeshData mesh;
        mesh.V = Array3f(Array3f::Dense::Zero(2, 3));
        mesh.scalars = {{"h", Array1f(Array1f::Dense{{0.0f}, {largest}})}};
        scene.objects.push_back({name, std::make_shared<const MeshData>(mesh), Eigen::Affine3d::Identity()});
    };
    add("mesh/ball", 1);
    add("mesh/ball", 2);
    add("mesh/ball 2", 3);
    add("mesh/box", 4);
    InferredSettings settings;
    settings.camera.up = "+y";
    settings.annotation.colorbar = true;
    std::vector<std::string> titles;
    for (const ColorBar& bar : annotation_of(scene, settings).bars) titles.push_back(bar.title);
    EXPECT_EQ(titles, (std::vector<std::string>{"h (mesh/ball 1)", "h (mesh/ball 3)", "h (mesh/ball 2)",
                                                "h (mesh/box)"}));
}

// Elevations of 2495 to 2505 in a scene whose origin is at 2500.
TEST(Annotation, BarsOfHeightsHaveTrueNumbers) {
    MeshData mesh;
    mesh.V = Array3f(Array3f::Dense{{0, -5, 0}, {1, 5, 0}});
    mesh.style.color_by = ColorBy::height;
    SceneSnapshot scene;
    scene.origin = Vec3d(1e6, 2500, 1e6);
    scene.objects.push_back({"m", std::make_shared<const MeshData>(mesh), Eigen::Affine3d::Identity()});
    InferredSettings settings;
    settings.camera.up = "+y";
    settings.annotation.colorbar = true;
    for (const ColorScale scale : {ColorScale::linear, ColorScale::log}) {
        settings.style.color_scale = scale;
        const ColorBar bar = annotation_of(scene, settings).bars.at(0);
        const std::vector<Tick> ticks = ticks_of(bar.range, 3);
        ASSERT_EQ(ticks.size(), 3u);
        EXPECT_EQ(ticks[0].text, "2495");
        EXPECT_EQ(ticks[1].text, "2500");
        EXPECT_EQ(ticks[2].text, "2505");
        EXPECT_NEAR(place_of(ticks[0], bar.range), 0, 1e-12);
        // On the logarithmic scale log(2500 / 2495) / log(2505 / 2495) = 0.5005 of it.
        EXPECT_NEAR(place_of(ticks[1], bar.range), 0.5, 6e-4);
        EXPECT_NEAR(place_of(ticks[2], bar.range), 1, 1e-12);
    }
}

TEST(Annotation, InfiniteValuesGoOnBeyondTheBar) {
    constexpr float infinite = std::numeric_limits<float>::infinity();
    InferredSettings settings;
    settings.camera.up = "+y";
    settings.annotation.colorbar = true;
    for (const float sign : {1.0f, -1.0f}) {
        MeshData mesh;
        mesh.V = Array3f(Array3f::Dense::Zero(3, 3));
        mesh.scalars = {{"t", Array1f(Array1f::Dense{{1.0f}, {3.0f}, {sign * infinite}})}};
        SceneSnapshot scene;
        scene.objects.push_back({"m", std::make_shared<const MeshData>(mesh), Eigen::Affine3d::Identity()});
        const ColorBar bar = annotation_of(scene, settings).bars.at(0);
        EXPECT_EQ(bar.range.clips_above(), sign > 0);
        EXPECT_EQ(bar.range.clips_below(), sign < 0);
        EXPECT_FALSE(bar.nan_color);
    }
}

}  // namespace easypbr::app::annotation_content_test
