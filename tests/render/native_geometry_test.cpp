// The two ways to fill the G-buffer must agree: the driver's rasteriser and the native one.
#include <cmath>
#include <random>

#include "easypbr/gl/context.h"
#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/render/raster/visibility.h"
#include "easypbr/scene/resolve.h"
#include "render_test.h"

namespace easypbr::render::native_geometry_test {
namespace {

struct Comparison {
    bool software = false;
    double covered = 0, one_sided = 0, depth_off = 0, normal_off = 0, albedo_off = 0, material_off = 0;
    double picture_off = 0;
};

/// Shares of pixels that differ, of all that either way covers.
Comparison compare_both(const Scene& scene, const Settings& settings, Vec2i size = Vec2i(320, 240)) {
    const auto context = gl::Context::create();
    if (!context->info().software) return {};
    const gl::ContextScope scope(*context);
    const SceneSnapshot snapshot = scene.snapshot();
    const ResolvedSettings resolved = resolve(snapshot, settings, size);
    Renderer renderer;
    std::map<Layer, Image> layers[2];
    Image pictures[2];
    for (const bool native : {false, true}) {
        renderer.allow_native_geometry(native);
        renderer.draw(snapshot, resolved, {size, 1, Encoding::srgb8});
        for (const Layer layer : {Layer::depth, Layer::normal_world, Layer::albedo, Layer::metallic,
                                  Layer::roughness, Layer::occlusion})
            layers[native][layer] = renderer.read_layer(layer);
        pictures[native] = renderer.read_picture();
    }
    Comparison result;
    result.software = true;
    for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) {
            const float a = layers[0][Layer::depth].at<float>(x, y)[0],
                        b = layers[1][Layer::depth].at<float>(x, y)[0];
            if (a == 0 && b == 0) continue;
            ++result.covered;
            if (a == 0 || b == 0) {
                ++result.one_sided;
                continue;
            }
            const Vec3 n(layers[0][Layer::normal_world].at<float>(x, y)),
                m(layers[1][Layer::normal_world].at<float>(x, y));
            const Vec3 c(layers[0][Layer::albedo].at<float>(x, y)),
                d(layers[1][Layer::albedo].at<float>(x, y));
            // The driver interpolates between vertices snapped to 1/256 of a pixel, the native way between
            // exact ones.
            result.depth_off += std::abs(a / b - 1) > 1e-4;
            result.normal_off += n.dot(m) < std::cos(radians(1.0));
            result.albedo_off += (c - d).cwiseAbs().maxCoeff() > 0.01f;
            const auto differs = [&](Layer layer) {
                return std::abs(layers[0][layer].at<float>(x, y)[0] - layers[1][layer].at<float>(x, y)[0]) >
                       0.01f;
            };
            result.material_off +=
                differs(Layer::metallic) || differs(Layer::roughness) || differs(Layer::occlusion);
            int most = 0;
            for (int k = 0; k < 3; ++k)
                most = std::max(most, std::abs(int(pictures[0].at<uint8_t>(x, y)[k]) -
                                               int(pictures[1].at<uint8_t>(x, y)[k])));
            result.picture_off += most > 8;
        }
    for (double* share : {&result.one_sided, &result.depth_off, &result.normal_off, &result.albedo_off,
                          &result.material_off, &result.picture_off})
        *share /= result.covered;
    return result;
}

void expect_agreement(const Scene& scene, const Settings& settings = {}) {
    const Comparison c = compare_both(scene, settings);
    if (!c.software) GTEST_SKIP() << "this machine has a GPU: the native rasteriser is not used";
    EXPECT_GT(c.covered, 5000);
    // Both snap to 1/256 of a pixel by the same rules; vertices that fall on a rounding boundary may go
    // either way.
    EXPECT_LE(c.one_sided, 0.0005);
    // Where a silhouette or crease runs through a pixel, one 1/256 decides which surface is seen.
    EXPECT_LE(c.depth_off, 0.005);
    EXPECT_LE(c.normal_off, 0.01);
    EXPECT_LE(c.albedo_off, 0.01);
    EXPECT_LE(c.material_off, 0.01);
    EXPECT_LE(c.picture_off, 0.01);
}

Mesh fine_teapot() {
    return make_teapot(1, 20);
}

TEST(NativeGeometry, Teapot) {
    Scene scene;
    scene.show(fine_teapot(), "teapot");
    expect_agreement(scene);
}

TEST(NativeGeometry, Orthographic) {
    Scene scene;
    scene.show(fine_teapot(), "teapot");
    Settings settings;
    settings.camera.projection = Projection::orthographic;
    expect_agreement(scene, settings);
}

TEST(NativeGeometry, FlatAndOneSided) {
    Scene scene;
    scene.show(fine_teapot(), "teapot");
    Settings settings;
    settings.style.flat = true;
    expect_agreement(scene, settings);
    settings.style.two_sided = false;
    expect_agreement(scene, settings);
}

TEST(NativeGeometry, VertexColorsAndParts) {
    Mesh mesh = fine_teapot();
    mesh.edit([](MeshData& data) {
        const Array3f V = data.V;
        data.C = ArrayXf(ArrayXf::Dense(((V.array() + 2) / 4).matrix()));
        data.materials.resize(2);
        data.materials[1].base_color = Vec3(0.2f, 0.9f, 0.4f);
        const int half = int(data.F.rows() / 2);
        data.parts = {{"a", 0, half, 0}, {"b", half, int(data.F.rows()) - half, 1}};
    });
    Scene scene;
    scene.show(mesh, "teapot");
    expect_agreement(scene);
}

TEST(NativeGeometry, MirroredAndScaledPoses) {
    Mesh mesh = fine_teapot();
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.linear() = Vec3d(-1, 0.5, 2).asDiagonal();
    mesh.set_T_parent_mesh(T);
    Scene scene;
    scene.show(mesh, "mirrored");
    Mesh other = fine_teapot();
    other.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0.5, 0.3, 0)));
    scene.show(other, "other");
    expect_agreement(scene);
    Settings settings;
    settings.style.two_sided = false;
    expect_agreement(scene, settings);
}

TEST(NativeGeometry, WrongWinding) {
    Mesh mesh = fine_teapot();
    mesh.set_F(Array3i(Array3i::Dense(mesh.F().rowwise().reverse())));
    Scene scene;
    scene.show(mesh, "inside out");
    expect_agreement(scene);
}

/// Waves, which no filter changes much.
Texture waves(double phase, Wrap wrap = Wrap::repeat) {
    auto image = std::make_shared<Image>(64, 48, 4, PixelType::u8);
    for (int y = 0; y < image->height(); ++y)
        for (int x = 0; x < image->width(); ++x)
            for (int c = 0; c < 4; ++c) {
                const double wave = std::sin(2 * pi * x / 64 + phase + c) * std::cos(2 * pi * y / 48 + c);
                image->at<uint8_t>(x, y)[c] = uint8_t(std::lround(127.5 + 100 * wave));
            }
    Texture texture;
    texture.image = image;
    texture.wrap_u = texture.wrap_v = wrap;
    texture.uv_transform << 2, 0.5f, 0.1f, -0.3f, 1.5f, 0.2f, 0, 0, 1;
    return texture;
}

Texture normals() {
    auto image = std::make_shared<Image>(64, 64, 3, PixelType::u8);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const double slope_x = 0.4 * std::sin(2 * pi * x / 64), slope_y = 0.3 * std::cos(2 * pi * y / 64);
            const Vec3d n = Vec3d(slope_x, slope_y, 1).normalized();
            for (int c = 0; c < 3; ++c)
                image->at<uint8_t>(x, y)[c] = uint8_t(std::lround((n[c] * 0.5 + 0.5) * 255));
        }
    Texture texture;
    texture.image = image;
    return texture;
}

Material with_all_maps() {
    Material material;
    material.base_color_texture = waves(0);
    material.metallic_texture = material.roughness_texture = waves(1, Wrap::mirror);
    material.metallic = material.roughness = 1;
    material.metallic_texture.channel = 2;
    material.roughness_texture.channel = 1;
    material.occlusion_texture = waves(2, Wrap::clamp);
    material.normal_texture = normals();
    material.emissive_texture = waves(3);
    material.emissive = Vec3(0.5f, 0.2f, 0.8f);
    return material;
}

TEST(NativeGeometry, AllMaps) {
    Mesh mesh = fine_teapot();
    mesh.set_material(with_all_maps());
    Scene scene;
    scene.show(mesh, "teapot");
    expect_agreement(scene);
    Settings settings;
    settings.style.flat = true;
    expect_agreement(scene, settings);
    settings.style.two_sided = false;
    expect_agreement(scene, settings);
    mesh.set_F(Array3i(Array3i::Dense(mesh.F().rowwise().reverse())));
    Scene inside_out;
    inside_out.show(mesh, "inside out");
    expect_agreement(inside_out);
}

// The pictures must agree too: what lights read of the extensions is packed by both.
TEST(NativeGeometry, MapsOfExtensions) {
    Mesh mesh = fine_teapot();
    Material material = with_all_maps();
    material.clearcoat = material.sheen_roughness = material.iridescence = material.anisotropy = 0.8f;
    material.clearcoat_roughness = 0.5f;
    material.sheen_color = Vec3(0.3f, 0.5f, 0.4f);
    material.clearcoat_texture = material.clearcoat_roughness_texture = waves(4);
    material.clearcoat_normal_texture = normals();
    material.sheen_color_texture = material.sheen_roughness_texture = waves(5, Wrap::mirror);
    material.specular_texture = material.specular_color_texture = waves(6);
    material.iridescence_texture = material.iridescence_thickness_texture = waves(7);
    material.anisotropy_texture = normals();
    mesh.set_material(material);
    Scene scene;
    scene.show(mesh, "teapot");
    expect_agreement(scene);
    material.alpha_mode = AlphaMode::mask;
    material.opacity_texture = waves(8);
    mesh.set_material(material);
    Scene cut_out;
    cut_out.show(mesh, "cut out");
    const Comparison c = compare_both(cut_out, {});
    if (!c.software) return;
    EXPECT_GT(c.covered, 3000);
    // The borders of the holes are where the driver's level of detail, of 2x2 pixels, says.
    EXPECT_LE(c.one_sided, 0.01);
    EXPECT_LE(c.material_off, 0.02);
    EXPECT_LE(c.picture_off, 0.02);
}

TEST(NativeGeometry, SeparateMapsWithoutFilter) {
    Mesh mesh = fine_teapot();
    Material material = with_all_maps();
    material.roughness_texture = waves(5);
    material.metallic_texture.filter = material.base_color_texture.filter = Filter::nearest;
    mesh.set_material(material);
    Scene scene;
    scene.show(mesh, "teapot");
    // Texels are of a few pixels: at their borders the sides may differ.
    const Comparison c = compare_both(scene, {});
    if (!c.software) GTEST_SKIP() << "this machine has a GPU: the native rasteriser is not used";
    EXPECT_LE(c.normal_off, 0.01);
    EXPECT_LE(c.albedo_off, 0.03);
    EXPECT_LE(c.material_off, 0.03);
}

TEST(NativeGeometry, MasksAreCutOut) {
    Mesh mesh = fine_teapot();
    Material material = with_all_maps();
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = 0.4f;
    mesh.set_material(material);
    Scene scene;
    scene.show(mesh, "teapot");
    // What is behind is seen through the holes.
    Mesh ball = make_sphere(0.8f, 60);
    scene.show(ball, "ball");
    const Comparison c = compare_both(scene, {});
    if (!c.software) GTEST_SKIP() << "this machine has a GPU: the native rasteriser is not used";
    // The driver filters alpha in 8 bits: the borders of holes move by a part of a pixel.
    EXPECT_LE(c.one_sided, 0.005);
    EXPECT_LE(c.depth_off, 0.01);
    EXPECT_LE(c.albedo_off, 0.02);
    EXPECT_LE(c.picture_off, 0.02);
}

TEST(NativeGeometry, EmissionAndUnlit) {
    Scene scene;
    Mesh glowing = fine_teapot(), plain = make_sphere(0.8f, 60), unlit = make_box(Vec3(1, 1, 1));
    Material material;
    material.emissive = Vec3(1, 0.5f, 0.1f);
    glowing.set_material(material);
    material = Material();
    material.unlit = true;
    material.base_color = Vec3(0.1f, 0.8f, 0.3f);
    unlit.set_material(material);
    plain.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(2, 0, 0)));
    unlit.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(-2, 0, 1)));
    scene.show(glowing, "glowing");
    scene.show(plain, "plain");
    scene.show(unlit, "unlit");
    expect_agreement(scene);
    Settings with_ground;
    with_ground.ground.mode = GroundMode::plane;
    expect_agreement(scene, with_ground);
}

// Three quarters of a sheet's pixels hold a point, off the middle and its diagonals, some of them on a second
// sheet far behind: both ways rasterise the same, and both must close the same gaps by the same neighbours.
TEST(NativeGeometry, GapsBetweenPointsAreClosed) {
    constexpr int n = 160, half = n / 2;
    std::mt19937 random(5);
    std::vector<Vec3> points;
    for (int y = -half; y < half; ++y)
        for (int x = -half; x < half; ++x) {
            if (random() % 4 == 0) continue;
            const float depth = random() % 8 == 0 ? -1.0f : 0.001f * float(random() % 9);
            points.emplace_back((float(x) + 0.6f) / half, (float(y) + 0.3f) / half, depth);
        }
    MeshData data;
    Array3f::Dense V(Eigen::Index(points.size()), 3);
    for (size_t i = 0; i < points.size(); ++i) V.row(Eigen::Index(i)) = points[i].transpose();
    data.V = Array3f(V);
    Scene scene;
    scene.show(Mesh(data), "sheet");
    Settings settings;
    settings.camera.projection = Projection::orthographic;
    settings.camera.position = Vec3d(0, 0, 5);
    settings.camera.target = Vec3d(0, 0, 0);
    settings.camera.ortho_height = 240.0 / half;
    settings.style.point_size = 1.0f;
    const Comparison open = compare_both(scene, settings);
    if (!open.software) GTEST_SKIP() << "this machine has a GPU: the native rasteriser is not used";
    settings.points.hole_filling = 3;
    const Comparison closed = compare_both(scene, settings);
    EXPECT_EQ(open.one_sided, 0);
    EXPECT_EQ(closed.one_sided, 0);
    EXPECT_EQ(closed.depth_off, 0);
    EXPECT_GT(closed.covered, open.covered * 1.2);
}

// A box behind a teapot that is drawn over it: it emits, and the teapot does not.
TEST(NativeGeometry, OneIsDrawnOverEverythingElse) {
    Mesh box = make_box(Vec3(0.8f, 0.8f, 0.8f));
    Material glowing;
    glowing.emissive = Vec3(0.2f, 0.5f, 0.1f);
    box.set_material(glowing);
    box.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0.3, -1.5)));
    Scene scene;
    scene.show(fine_teapot(), "teapot");
    scene.show(box, "box");
    const double hidden = compare_both(scene, {}).covered;
    Style over;
    over.overlay = true;
    box.set_style(over);
    expect_agreement(scene);
    EXPECT_NEAR(compare_both(scene, {}).covered, hidden, 5);
}

// Light of a native picture stays in host memory; what the driver lights next does not begin with it.
TEST(NativeGeometry, LightOfThePictureBeforeIsForgotten) {
    Scene scene;
    scene.show(fine_teapot(), "teapot");
    Settings settings;
    settings.ground.mode = GroundMode::plane;
    app::Session again(scene), fresh(scene);
    app::PictureOptions options;
    options.size = Vec2i(64, 48);
    again.render(options);
    again.settings() = settings;
    fresh.settings() = settings;
    EXPECT_TRUE(std::ranges::equal(again.render(options).bytes(), fresh.render(options).bytes()));
}

// What reaches before the near plane is clipped there, and what reaches far outside at a guard band.
TEST(NativeGeometry, ClipsAtTheNearPlaneAndFarOutside) {
    Mesh mesh = fine_teapot();
    mesh.set_material(with_all_maps());
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        // Not larger: the driver computes in single precision where it clips.
        Mesh large = make_plane(projection == Projection::perspective ? 100.0f : 1000.0f);
        large.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(0, -1, 0)));
        Scene scene;
        scene.show(mesh, "teapot");
        scene.show(large, "plane");
        for (const double near : {0.01, 2.0, 2.8}) {
            Settings settings;
            settings.camera.projection = projection;
            settings.camera.position = Vec3d(0.3, 1, 3);
            settings.camera.target = Vec3d(0, 0, 0);
            settings.camera.near = near;
            const Comparison c = compare_both(scene, settings);
            if (!c.software) GTEST_SKIP() << "this machine has a GPU: the native rasteriser is not used";
            EXPECT_GT(c.covered, 5000) << near;
            EXPECT_LE(c.one_sided, 0.002) << near << ", the driver cuts elsewhere by a part of a pixel";
            EXPECT_LE(c.depth_off, 0.01) << near;
            EXPECT_LE(c.normal_off, 0.01) << near;
            EXPECT_LE(c.albedo_off, 0.02) << near;
        }
    }
}

// The picture is whole where the room reaches before the near plane.
TEST(NativeGeometry, FromInside) {
    Scene scene;
    scene.show(make_sphere(1, 128), "room");
    Settings settings;
    settings.camera.position = Vec3d(0, 0, 0.5);
    settings.camera.target = Vec3d(0, 0, 0);
    const Comparison c = compare_both(scene, settings);
    if (!c.software) GTEST_SKIP() << "this machine has a GPU: the native rasteriser is not used";
    EXPECT_EQ(c.covered, 320 * 240);
    EXPECT_EQ(c.one_sided, 0);
}

// A closed mesh is drawn without its back faces only as long as none of them can be seen: not from within,
// and not where the near plane cuts it open. Also when it is drawn again, and known to be closed; its few
// faces are the driver's, its many the native rasteriser's.
TEST(NativeGeometry, RoomsAreSeenFromWithin) {
    const Vec2i size(64, 48);
    for (const int segments : {16, 128}) {
        Scene scene;
        scene.show(make_sphere(1, segments), "room");
        app::Session session(scene);
        const auto covered = [&](const Vec3d& eye, double near) {
            session.settings().camera.position = eye;
            session.settings().camera.target = Vec3d(0, 0, -1);
            session.settings().camera.near = near;
            const Image depth = session.render_layers({"depth"}, size).at("depth");
            return std::ranges::count_if(depth.pixels<float>(), [](float z) { return z > 0; });
        };
        for (int again = 0; again < 3; ++again) {
            EXPECT_EQ(covered(Vec3d(0, 0, 0.5), 0.01), size.prod())
                << segments << ", drawn before: " << again;
            // From outside with the front cut away: the wall behind is seen, and its silhouette is the same.
            const auto whole = covered(Vec3d(0, 0, 3), 0.01);
            EXPECT_NEAR(double(covered(Vec3d(0, 0, 3), 2.5)), double(whole), 0.02 * double(whole))
                << segments;
        }
    }
}

}  // namespace
}  // namespace easypbr::render::native_geometry_test
