// Targets live in host memory or in a texture; transfers between the two are counted, and are those that a
// frame needs.
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/memory_pool.h"
#include "easypbr/geometry/surfels.h"
#include "easypbr/gl/context.h"
#include "easypbr/render/frame/target.h"
#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/scene/resolve.h"
#include "render_test.h"

namespace easypbr::render::target_test {
namespace {

class TargetTest : public testing::Test {
  protected:
    /// Writes 1, 2, ... in host memory.
    void write(const PixelRect& area) const {
        target_.write(area);
        float next = 0;
        for (float& value : target_.pixels<float>()) value = ++next;
    }
    void clear_texture(float value) const {
        const float rgba[4] = {value, 0, 0, 0};
        gl::Framebuffer({&target_.drawn()}).clear_color(0, rgba);
    }

    const std::unique_ptr<gl::Context> context_ = gl::Context::create();
    const gl::ContextScope scope_{*context_};
    const Target target_{gl::Format::r32f, Vec2i(3, 2)};
    Transfers transfers_;
};

TEST_F(TargetTest, ReleasesHostMemory) {
    const Target large(gl::Format::rgba32f, Vec2i(256, 128));
    const size_t given = pooled_memory().given;
    large.write(large.whole());
    // Of the pool, which may give a larger block.
    EXPECT_GE(pooled_memory().given, given + size_t{256} * 128 * 16);
    large.release();
    EXPECT_EQ(pooled_memory().given, given);
    EXPECT_FALSE(large.is_ahead());
    EXPECT_TRUE(large.pixels<Vec4>().empty());
    // It is written again as if it were new.
    large.write({8, 4, 2, 1});
    EXPECT_EQ(large.pixels<Vec4>().size(), 2u);
}

TEST_F(TargetTest, KeepsItsTextureWhenHostMemoryIsReleased) {
    clear_texture(5);
    target_.download(target_.whole(), transfers_);
    target_.release();
    EXPECT_EQ(target_.read<float>(transfers_), std::vector<float>(6, 5.0f));
    EXPECT_EQ(transfers_.downloads, 2);
}

TEST_F(TargetTest, HostMemoryIsReadWithoutATransfer) {
    write({1, 0, 2, 2});
    EXPECT_EQ(target_.read<float>(transfers_), (std::vector<float>{0, 1, 2, 0, 3, 4}));
    EXPECT_EQ(transfers_, Transfers());
}

TEST_F(TargetTest, TheTextureNeedsAnUpload) {
    clear_texture(7);
    write({1, 1, 2, 1});
    EXPECT_THROW(target_.texture(), Error);
    target_.upload(transfers_);
    target_.upload(transfers_);  // there already
    EXPECT_EQ(transfers_, (Transfers{1, 0, 8, 0}));
    float pixels[6];
    gl::Framebuffer({&target_.texture()})
        .read(0, gl::Format::r32f, 0, 0, 3, 2, std::as_writable_bytes(std::span(pixels)));
    EXPECT_EQ(std::vector<float>(pixels, pixels + 6), (std::vector<float>{7, 7, 7, 7, 1, 2}));
}

TEST_F(TargetTest, WhatTheDriverDrewIsDownloadedOnce) {
    write(target_.whole());
    clear_texture(5);
    target_.download({0, 0, 2, 1}, transfers_);
    target_.download({1, 0, 1, 1}, transfers_);  // a part of what is there
    EXPECT_EQ(transfers_, (Transfers{0, 1, 0, 8}));
    EXPECT_EQ(target_.pixels<float>()[1], 5);
    EXPECT_EQ(target_.read<float>(transfers_), std::vector<float>(6, 5));
    EXPECT_EQ(target_.read<float>(transfers_), std::vector<float>(6, 5));
    EXPECT_EQ(transfers_.downloads, 2);
    clear_texture(6);
    EXPECT_EQ(target_.read<float>(transfers_), std::vector<float>(6, 6));
}

TEST_F(TargetTest, NoMemoryUntilItIsAskedFor) {
    EXPECT_TRUE(bool(target_));
    EXPECT_FALSE(bool(Target()));
    target_.write({});
    target_.upload(transfers_);
    EXPECT_EQ(transfers_, Transfers());
}

/// The transfers of a picture without shadows, whose maps would count too; nothing on machines with a GPU.
std::optional<Transfers> transfers_of(const Scene& scene, const Settings& changes, int samples = 1) {
    const auto context = gl::Context::create();
    if (!context->info().software) return std::nullopt;
    const gl::ContextScope scope(*context);
    Settings settings = changes;
    settings.shadows.enabled = false;
    const SceneSnapshot snapshot = scene.snapshot();
    const Vec2i size(64, 48);
    Renderer renderer;
    renderer.draw(snapshot, resolve(snapshot, settings, size), {size, samples, Encoding::srgb8});
    return renderer.transfers();
}

Scene scene_of(const Mesh& mesh) {
    Scene scene;
    scene.show(mesh, "mesh");
    return scene;
}

/// Albedo, normal, material, depth, and the depth of the driver's depth test.
constexpr int gbuffer_uploads = 5;

TEST(Transfers, ANativeFrameStaysInHostMemory) {
    const Mesh mesh = make_teapot(1, 20);
    for (const Scene& scene : {scene_of(mesh), scene_of(surfels_from_mesh(mesh))}) {
        const auto transfers = transfers_of(scene, {});
        if (!transfers) GTEST_SKIP() << "this machine has a GPU: nothing is drawn natively";
        EXPECT_EQ(*transfers, Transfers());
    }
}

TEST(Transfers, OverlaysAndEffectsStayInHostMemory) {
    Settings settings;
    settings.bloom.enabled = settings.outline.enabled = settings.depth_of_field.enabled = true;
    settings.style.show_wireframe = true;
    MeshData cloud;
    cloud.V = make_teapot(1, 20).V();
    for (const Scene& scene : {scene_of(make_teapot(1, 20)), scene_of(Mesh(cloud))}) {
        const auto transfers = transfers_of(scene, settings);
        if (!transfers) GTEST_SKIP() << "this machine has a GPU: nothing is drawn natively";
        EXPECT_EQ(*transfers, Transfers());
    }
}

TEST(Transfers, ExtendedSurfacesStayInHostMemory) {
    Mesh mesh = make_teapot(1, 20);
    Material material;
    material.clearcoat = material.iridescence = material.anisotropy = 0.5f;
    material.sheen_color = Vec3(0.2f, 0.4f, 0.6f);
    material.emissive = Vec3(0.1f, 0.1f, 0.1f);
    mesh.set_material(material);
    const auto transfers = transfers_of(scene_of(mesh), {});
    if (!transfers) GTEST_SKIP() << "this machine has a GPU: nothing is drawn natively";
    EXPECT_EQ(*transfers, Transfers());
}

Mesh pane_of(const Material& material) {
    Mesh pane = make_sphere(1.5f, 20);
    pane.set_material(material);
    return pane;
}

TEST(Transfers, LayersStayInHostMemory) {
    Scene scene = scene_of(make_teapot(1, 20));
    Material glass;
    glass.opacity = 0.5f;
    glass.alpha_mode = AlphaMode::blend;
    scene.show(pane_of(glass), "pane");
    Material volume;
    volume.transmission = volume.thickness = 1;
    volume.roughness = 0.3f;
    scene.show(pane_of(volume), "volume");
    const auto transfers = transfers_of(scene, {});
    if (!transfers) GTEST_SKIP() << "this machine has a GPU: nothing is drawn natively";
    EXPECT_EQ(*transfers, Transfers());
}

// Layers with a shader of their own are the driver's.
TEST(Transfers, SurfacesAreUploadedOnceForPassesOfTheDriver) {
    Settings settings;
    settings.ssao.enabled = settings.shadows.enabled = false;
    Scene scene = scene_of(make_teapot(1, 20));
    Material mist;
    mist.opacity = 0.5f;
    mist.alpha_mode = AlphaMode::blend;
    mist.shader.text = "void surface(inout Surface s) { s.roughness = 0.3; }";
    scene.show(pane_of(mist), "pane");
    const auto transfers = transfers_of(scene, settings);
    if (!transfers) GTEST_SKIP() << "this machine has a GPU: nothing is drawn natively";
    EXPECT_EQ(transfers->uploads, gbuffer_uploads + 1);  // and the light
    EXPECT_EQ(transfers->downloads, 0);
}

TEST(Transfers, RaysReadNativeSurfacesWhereTheyAre) {
    Settings settings;
    settings.rays.enabled = true;
    settings.ground.mode = GroundMode::none;
    const int samples = 2;
    const auto transfers = transfers_of(scene_of(make_teapot(1, 20)), settings, samples);
    if (!transfers) GTEST_SKIP() << "this machine has a GPU: nothing is drawn natively";
    EXPECT_EQ(*transfers, Transfers());
}

TEST(Transfers, RaysDownloadWhatTheDriverDrew) {
    Settings settings;
    settings.rays.enabled = true;
    Mesh mesh = make_teapot(1, 20);
    Material material;
    material.shader.text = "void surface(inout Surface s) { s.roughness = 0.3; }";  // drawn by the driver
    mesh.set_material(material);
    const auto transfers = transfers_of(scene_of(mesh), settings, 2);
    if (!transfers) GTEST_SKIP() << "this machine has a GPU: nothing is drawn natively";
    EXPECT_EQ(transfers->downloads, 2 * 3);  // normal, material, depth
}

TEST(Transfers, NativeGroundTruthNeverLeavesHostMemory) {
    const auto context = gl::Context::create();
    if (!context->info().software) GTEST_SKIP() << "this machine has a GPU: nothing is drawn natively";
    const gl::ContextScope scope(*context);
    const SceneSnapshot snapshot = scene_of(make_teapot(1, 20)).snapshot();
    const Vec2i size(64, 48);
    Renderer renderer;
    renderer.draw_surfaces(snapshot, resolve(snapshot, {}, size), size);
    const SurfaceFrame surfaces = renderer.read_surfaces();
    EXPECT_GT(std::ranges::count(surfaces.object, 1u), 100);
    EXPECT_EQ(renderer.transfers(), Transfers());
}

// A path traced picture needs its G-buffer no more once all frames are in the mean. Who asked for surfaces
// has them, and a frame of rasterised light keeps its own.
TEST(Renderer, PathTracedPicturesKeepNoSurfacesUnlessAsked) {
    const auto context = gl::Context::create();
    const gl::ContextScope scope(*context);
    const Scene scene = scene_of(make_sphere(1));
    const SceneSnapshot snapshot = scene.snapshot();
    const Vec2i size(64, 48);
    Settings settings;
    settings.path.enabled = true;
    const ResolvedSettings paths = resolve(snapshot, settings, size);
    settings.path.enabled = false;
    Renderer renderer;
    renderer.draw(snapshot, resolve(snapshot, settings, size), {size, 2});
    EXPECT_EQ(renderer.read_layer(Layer::depth).width(), size.x());
    renderer.draw(snapshot, paths, {size, 2});
    EXPECT_THROW(renderer.read_layer(Layer::depth), ArgumentError);
    EXPECT_EQ(renderer.read_picture().width(), size.x());
    DrawOptions options{size, 2};
    options.surfaces = true;
    renderer.draw(snapshot, paths, options);
    EXPECT_EQ(renderer.read_layer(Layer::depth).width(), size.x());
}

}  // namespace
}  // namespace easypbr::render::target_test
