// Which maps are drawn when, what casts, and any number of lights.
#include <bit>
#include <random>

#include "easypbr/core/error.h"
#include "easypbr/render/frame/shadow_view.h"
#include "easypbr/scene/settings.h"
#include "shadow_test.h"

namespace easypbr::shadow_maps_test {
namespace {

Scene two_boxes() {
    Scene scene;
    scene.show(rectangle(-2, -2, 2, 2, 0), "floor");
    for (const char* name : {"a", "b"}) {
        Mesh box = make_box(Vec3(0.4f, 0.4f, 0.4f));
        box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(name[0] == 'a' ? -0.7 : 0.7, 0, 0.2)));
        scene.show(box, name);
    }
    scene.set_light("lamp", point(Vec3(1, 2, 5), 0.3f));
    scene.set_light("inside", point(Vec3(0, 0.5f, 0.3f), 0.1f));
    scene.set_light("sun", directional(Vec3(-1, -1, -2)));
    return scene;
}

class ShadowCache : public testing::Test {
  protected:
    ShadowCache() : session_(shadow_session(two_boxes(), ShadowMode::soft)) {
        session_.settings().shadows.enabled = true;
        session_.settings().shadows.resolution = 128;
        look_from(session_, Vec3d(3, -4, 5));
        EXPECT_EQ(drawn_by([](Session&) {}), 3u);
    }
    using Session = app::Session;

    /// How many lights' maps a picture needs after a change.
    template <class Change>
    uint64_t drawn_by(Change&& change) {
        const uint64_t before = session_.shadow_maps_drawn();
        change(session_);
        session_.render();
        return session_.shadow_maps_drawn() - before;
    }

    template <class Change>
    void change_light(const std::string& name, Change&& change) {
        Light light = session_.scene().light(name);
        change(light);
        session_.scene().set_light(name, light);
    }

    Session session_;
};

TEST_F(ShadowCache, CameraAloneDrawsNone) {
    const uint64_t before = session_.shadow_maps_drawn();
    for (int i = 0; i < 100; ++i) {
        look_from(session_, Vec3d(3 * std::cos(0.06 * i), 3 * std::sin(0.06 * i), 4));
        session_.render();
    }
    EXPECT_EQ(session_.shadow_maps_drawn(), before);
}

TEST_F(ShadowCache, ALightDrawsItsOwn) {
    EXPECT_EQ(drawn_by([&](Session&) { change_light("lamp", [](Light& l) { l.position.x() += 0.1f; }); }),
              1u);
    EXPECT_EQ(drawn_by([&](Session&) { change_light("inside", [](Light& l) { l.position.x() += 0.1f; }); }),
              1u);
    EXPECT_EQ(drawn_by([&](Session&) { change_light("sun", [](Light& l) { l.direction.x() += 0.1f; }); }),
              1u);
    EXPECT_EQ(drawn_by([&](Session& s) { s.scene().set_light("new", point(Vec3(0, 0, 6))); }), 1u);
    EXPECT_EQ(drawn_by([&](Session& s) { s.scene().remove_light("new"); }), 0u);
    // What a map does not show.
    EXPECT_EQ(drawn_by([&](Session&) { change_light("lamp", [](Light& l) { l.intensity *= 2; }); }), 0u);
    EXPECT_EQ(drawn_by([&](Session&) { change_light("lamp", [](Light& l) { l.color = Vec3(1, 0, 0); }); }),
              0u);
    // Penumbrae of 0.3 and 0.29 need no room. Those of 1 and 0.95 have a radius from 1/16 to 1/8, the power
    // of two for which there is room.
    EXPECT_EQ(drawn_by([&](Session&) { change_light("lamp", [](Light& l) { l.radius = 0.29f; }); }), 0u);
    EXPECT_EQ(drawn_by([&](Session&) { change_light("lamp", [](Light& l) { l.radius = 1; }); }), 1u);
    EXPECT_EQ(drawn_by([&](Session&) { change_light("lamp", [](Light& l) { l.radius = 0.95f; }); }), 0u);
    EXPECT_EQ(drawn_by([&](Session&) { change_light("lamp", [](Light& l) { l.casts_shadows = false; }); }),
              0u);
}

TEST_F(ShadowCache, ACasterDrawsAll) {
    Mesh box = session_.scene().get("a");
    const auto moved = [](double x) { return Eigen::Affine3d(Eigen::Translation3d(x, 0, 0.2)); };
    EXPECT_EQ(drawn_by([&](Session&) { box.set_T_parent_mesh(moved(-0.5)); }), 3u) << "moved";
    EXPECT_EQ(drawn_by([&](Session&) { box.set_V(Array3f(Array3f::Dense(box.V() * 1.5f))); }), 3u)
        << "changed";
    EXPECT_EQ(drawn_by([&](Session& s) { s.scene().hide("a"); }), 3u) << "vanished";
    EXPECT_EQ(drawn_by([&](Session& s) { s.scene().hide("a", false); }), 3u) << "appeared";
    EXPECT_EQ(drawn_by([&](Session& s) { s.scene().remove("b"); }), 3u) << "removed";
    Material red = matt();
    red.base_color = Vec3(1, 0, 0);
    EXPECT_EQ(drawn_by([&](Session&) { box.set_material(red); }), 0u)
        << "another colour casts the same shadow";
    red.alpha_mode = AlphaMode::mask;
    EXPECT_EQ(drawn_by([&](Session&) { box.set_material(red); }), 3u) << "cut out";
    EXPECT_EQ(drawn_by([&](Session& s) { s.settings().shadows.mode = ShadowMode::pcf; }), 0u);
    EXPECT_EQ(drawn_by([&](Session& s) { s.settings().shadows.resolution = 256; }), 3u);
    EXPECT_EQ(drawn_by([&](Session& s) { s.settings().shadows.enabled = false; }), 0u);
}

// The picture is the one of a session that never kept a map.
TEST_F(ShadowCache, KeptMapsShowTheSame) {
    Mesh box = session_.scene().get("a");
    box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(-0.5, 0.3, 0.2)));
    change_light("lamp", [](Light& l) { l.position = Vec3d(-1, 2, 4); });
    session_.render();
    look_from(session_, Vec3d(-3, -3, 4));
    const Image kept = render_linear(session_);
    app::Session fresh(session_.scene());
    fresh.settings() = session_.settings();
    EXPECT_TRUE(std::ranges::equal(kept.bytes(), render_linear(fresh).bytes()));
}

// The ground is drawn by the driver: without it maps would be in host memory.
TEST_F(ShadowCache, ALightThatReachesNothingDrawsNone) {
    session_.allow_native_shading(false);
    session_.render();
    // The floor ends at x = 2, the light's range at 2.5 before the ground is there.
    const auto far_light = [](Light& l) {
        l.position = Vec3d(4.5, 0, 0.3);
        l.range = 2;
    };
    EXPECT_EQ(drawn_by([&](Session&) { change_light("inside", far_light); }), 0u);
    EXPECT_EQ(drawn_by([&](Session&) { change_light("inside", [](Light& l) { l.range = 2.7f; }); }), 1u);
    EXPECT_EQ(drawn_by([&](Session&) { change_light("inside", [](Light& l) { l.range = 2; }); }), 0u);
    EXPECT_EQ(drawn_by([&](Session&) { change_light("inside", [](Light& l) { l.position.x() = 5; }); }), 0u);
    EXPECT_EQ(drawn_by([&](Session& s) { s.settings().ground.mode = GroundMode::plane; }), 1u)
        << "the ground is everywhere";
}

// A cube's face that sees nothing is drawn once something is there to be seen.
TEST_F(ShadowCache, TheGroundNeedsMore) {
    session_.render();
    change_light("lamp", [](Light& l) { l.position = Vec3d(2.2, 0.3, 0.3); });
    const uint64_t before = session_.shadow_maps_drawn();
    session_.render();
    session_.settings().ground.mode = GroundMode::plane;
    const Image kept = render_linear(session_);
    EXPECT_EQ(session_.shadow_maps_drawn(), before + 2);
    app::Session fresh(session_.scene());
    fresh.settings() = session_.settings();
    EXPECT_TRUE(std::ranges::equal(kept.bytes(), render_linear(fresh).bytes()));
    session_.settings().ground.mode = GroundMode::none;
    session_.render();
    EXPECT_EQ(session_.shadow_maps_drawn(), before + 2);
}

// Maps beyond the memory are drawn from in turns: of 4096 texels a side, 64 MB each, there is room for 8
// of 13.
TEST_F(ShadowCache, MoreLightsThanMemoryShowTheSame) {
    const auto lit_by = [&](std::initializer_list<const char*> names) {
        for (const char* name : {"lamp", "inside", "sun"})
            change_light(name, [&](Light& l) { l.enabled = std::ranges::count(names, name) > 0; });
        return render_linear(session_);
    };
    session_.settings().shadows.resolution = 4096;
    session_.settings().shadows.mode = ShadowMode::hard;
    change_light("lamp", [](Light& l) { l.position = Vec3d(0.1, 0.3, 0.4); });
    const Image all = lit_by({"lamp", "inside", "sun"}), again = render_linear(session_);
    EXPECT_TRUE(std::ranges::equal(all.bytes(), again.bytes()));
    const Image parts[] = {lit_by({"lamp"}), lit_by({"inside"}), lit_by({"sun"})};
    for (size_t i = 0; i < 4 * all.pixel_count(); ++i) {
        if (i % 4 == 3) continue;
        float sum = 0;
        for (const Image& part : parts) sum += part.pixels<float>()[i];
        // Radiance is held in half floats and added block by block.
        ASSERT_NEAR(all.pixels<float>()[i], sum, 4e-3f * std::max(1.0f, sum)) << i;
    }
}

// Every point belongs to the face of its largest component; a face is needed if one of the box does.
TEST(ShadowView, NeedsTheFacesThatSeeAPointOfTheBox) {
    render::ShadowProjection cube;
    cube.count = 6;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> at(-2, 2);
    std::array<int, 7> seen{};
    for (int round = 0; round < 300; ++round) {
        const Vec3d light(at(random), at(random), at(random));
        Box3d box(Vec3d(at(random), at(random), at(random)));
        box.extend(Vec3d(at(random), at(random), at(random)));
        for (auto& view : cube.views) view.position = light;
        unsigned expected = 0;
        constexpr int n = 40;
        for (int i = 0; i < n * n * n; ++i) {
            const Vec3d part = Vec3d(i % n, i / n % n, i / n / n) / (n - 1);
            const Vec3d p = box.min() + part.cwiseProduct(box.sizes()) - light;
            Eigen::Index axis = 0;
            p.cwiseAbs().maxCoeff(&axis);
            expected |= 1u << (2 * axis + (p[axis] < 0));
        }
        const unsigned needed = render::needed_maps(cube, box);
        EXPECT_EQ(needed & expected, expected);
        // The grid misses what is thinner than its gaps.
        EXPECT_LE(std::popcount(needed), std::popcount(expected) + 1);
        ++seen[size_t(std::popcount(needed))];
    }
    EXPECT_GT(seen[1], 10);
    EXPECT_GT(seen[3], 10);
    EXPECT_GT(seen[6], 5);
}

/// Part of the light on a row of the floor at y = 0 under a square caster from -0.5 to 0.5 at height 0.5, lit
/// from above and seen from below it.
LitParts under_caster(const Mesh& caster, int samples, ShadowMode mode = ShadowMode::hard) {
    Scene scene;
    scene.show(rectangle(-1, -1, 1, 1, 0), "floor");
    scene.show(caster, "caster");
    scene.set_light("sun", directional(Vec3(0, 0, -1)));
    app::Session session = shadow_session(scene, mode, 128);
    look_from(session, Vec3d(0, -4, 0.8), 25);
    session.settings().camera.target = Vec3d(0, 0, 0);
    return lit_parts(session, samples);
}

/// Mean over the floor of x0 .. x1, y -0.3 .. 0.3.
double mean_lit(const LitParts& lit, double x0, double x1) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < lit.depth.height(); ++y)
        for (int x = 0; x < lit.depth.width(); ++x) {
            const Vec3d p = lit.position(x, y);
            if (lit.at(x, y) < 0 || std::abs(p.z()) > 1e-3 || std::abs(p.y()) > 0.3 || p.x() < x0 ||
                p.x() > x1)
                continue;
            sum += lit.at(x, y);
            ++count;
        }
    EXPECT_GT(count, 50);
    return sum / count;
}

TEST(ShadowCasters, MasksCastWithTheirHoles) {
    Material m = matt();
    m.alpha_mode = AlphaMode::mask;
    Image alpha(2, 1, 1, PixelType::u8);
    alpha.at<uint8_t>(0, 0)[0] = 0;
    alpha.at<uint8_t>(1, 0)[0] = 255;
    m.opacity_texture.image = std::make_shared<const Image>(alpha);
    m.opacity_texture.filter = Filter::nearest;
    const LitParts lit = under_caster(rectangle(-0.5f, -0.5f, 0.5f, 0.5f, 0.5f, m), 1);
    EXPECT_EQ(mean_lit(lit, -0.45, -0.05), 1);
    EXPECT_EQ(mean_lit(lit, 0.05, 0.45), 0);
}

// A surface of opacity 0.3 stops 0.3 of the light; tinted_shadow_test.cpp has more.
TEST(ShadowCasters, BlendedOnesCastTheirOpacity) {
    Material m = matt();
    m.alpha_mode = AlphaMode::blend;
    m.opacity = 0.3f;
    const LitParts lit = under_caster(rectangle(-0.5f, -0.5f, 0.5f, 0.5f, 0.5f, m), 1);
    EXPECT_NEAR(mean_lit(lit, -0.4, 0.4), 0.7, 1e-3);
}

TEST(ShadowCasters, BothSidesCast) {
    Material m = matt();
    m.double_sided = false;
    Mesh turned = rectangle(-0.5f, -0.5f, 0.5f, 0.5f, 0.5f, m);
    turned.set_F(Array3i(Array3i::Dense(turned.F().rowwise().reverse())));
    EXPECT_EQ(mean_lit(under_caster(turned, 1), -0.4, 0.4), 0);
}

// The native rasteriser's maps are the driver's, but for texels on edges, which either may round to the other
// side, and depths in planes of snapped vertices.
TEST(ShadowCasters, NativeAndDriverAgree) {
    Scene scene;
    scene.show(make_plane(4), "floor");
    scene.show(make_teapot(1, 20), "teapot");
    scene.set_light("lamp", point(Vec3(2, 4, 1)));
    scene.set_light("sun", directional(Vec3(-1, -2, 0.5f)));
    scene.set_light("inside", point(Vec3(0.2f, 0.6f, 1)));
    app::Session session = plain_session(scene, 128);
    session.settings().shadows.enabled = true;
    session.settings().shadows.mode = ShadowMode::pcf;
    Image images[2];
    for (const bool native : {false, true}) {
        session.allow_native_geometry(native);
        // The maps are kept, so that a new light is needed to see them drawn the other way.
        session.settings().shadows.resolution = native ? 512 : 511;
        session.render();
        session.settings().shadows.resolution = 512;
        images[native] = render_linear(session);
    }
    double different = 0;
    for (size_t i = 0; i < images[0].pixel_count(); ++i) {
        const float a = images[0].pixels<float>()[4 * i + 1], b = images[1].pixels<float>()[4 * i + 1];
        different += std::abs(a - b) > 0.02f * (a + b);
    }
    EXPECT_LE(different / double(images[0].pixel_count()), 0.005);
}

// Over an infinitely small light nothing is soft: zero is a radius like any.
TEST(ShadowLights, RadiusZeroIsSharp) {
    const LitParts lit = under_caster(rectangle(-0.5f, -0.5f, 0.5f, 0.5f, 0.5f), 4, ShadowMode::soft);
    EXPECT_EQ(mean_lit(lit, -0.45, 0.45), 0);
    EXPECT_EQ(mean_lit(lit, 0.55, 0.95), 1);
}

TEST(ShadowLights, WrongOnesAreNamed) {
    Scene scene = two_boxes();
    app::Session session = shadow_session(scene, ShadowMode::soft);
    const auto message = [&](auto&& change) {
        Light light = point(Vec3(1, 1, 3), 0.1f);
        change(light);
        scene.set_light("bad", light);
        try {
            session.render();
        } catch (const ArgumentError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    const float nan = std::nanf("");
    EXPECT_EQ(
        message([](Light& l) { l.radius = -1.0f; }),
        "light 'bad': radius: expected a number of at least 0 world units, or 'auto' or 'follow', got -1");
    EXPECT_EQ(
        message([&](Light& l) { l.radius = nan; }),
        "light 'bad': radius: expected a number of at least 0 world units, or 'auto' or 'follow', got nan");
    EXPECT_EQ(message([](Light& l) { l.type = LightType::directional, l.angular_radius_deg = 60; }),
              "light 'bad': angular_radius_deg: expected 0 to 45 degrees, got 60");
    EXPECT_EQ(message([](Light& l) { l.type = LightType::spot, l.direction = Vec3::Zero(); }),
              "light 'bad': direction: expected a vector with a length, got (0, 0, 0)");
    EXPECT_EQ(message([&](Light& l) { l.position.y() = nan; }),
              "light 'bad': position: expected finite numbers, got (1, nan, 3)");
    EXPECT_EQ(message([](Light&) {}), "accepted");
}

// A closed box around a light keeps all of it in, wherever the light is in it.
TEST(ShadowLights, ALightInsideAnObject) {
    for (const ShadowMode mode : {ShadowMode::hard, ShadowMode::pcf, ShadowMode::soft})
        for (const Vec3& position :
             {Vec3(-0.7f, 0, 0.2f), Vec3(-0.75f, 0.1f, 0.3f), Vec3(-0.7f, 0, 0.399f)}) {
            Scene scene = two_boxes();
            for (const std::string& name : scene.light_names()) scene.remove_light(name);
            scene.set_light("inside", point(position, 0.02f));
            app::Session session = shadow_session(scene, mode);
            look_from(session, Vec3d(3, -4, 5));
            session.settings().shadows.enabled = true;
            const Image image = render_linear(session);
            float most = 0;
            for (size_t i = 0; i < image.pixel_count(); ++i) {
                ASSERT_TRUE(std::isfinite(image.pixels<float>()[4 * i + 1]));
                most = std::max(most, image.pixels<float>()[4 * i + 1]);
            }
            // The floor beside the box would have a radiance of 1. Of a soft light near a wall, which reaches
            // through it in the last place, estimates may let a little pass.
            EXPECT_LE(most, mode == ShadowMode::soft ? 0.03f : 0.0f) << int(mode);
        }
}

/// The sum of pictures of one light each.
Image sum_of_each(const Scene& scene, ShadowMode mode, int resolution) {
    Image sum;
    for (const std::string& name : scene.light_names()) {
        Scene one;
        for (const std::string& mesh : scene.names()) one.show(scene.get(mesh), mesh);
        one.set_light(name, scene.light(name));
        app::Session session = shadow_session(one, mode);
        session.settings().shadows.enabled = true;
        session.settings().shadows.resolution = resolution;
        look_from(session, Vec3d(3, -4, 5));
        const Image image = render_linear(session);
        if (sum.empty()) sum = Image(image.width(), image.height(), 4, PixelType::f32);
        for (size_t i = 0; i < sum.pixel_count() * 4; ++i) sum.pixels<float>()[i] += image.pixels<float>()[i];
    }
    return sum;
}

void expect_sum(const Scene& scene, int resolution) {
    app::Session session = shadow_session(scene, ShadowMode::pcf);
    session.settings().shadows.enabled = true;
    session.settings().shadows.resolution = resolution;
    look_from(session, Vec3d(3, -4, 5));
    const Image all = render_linear(session), sum = sum_of_each(scene, ShadowMode::pcf, resolution);
    for (size_t i = 0; i < all.pixel_count(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            const float expected = sum.pixels<float>()[4 * i + c];
            // Sums of floats in another order.
            ASSERT_NEAR(all.pixels<float>()[4 * i + c], expected, 1e-5f * (1 + expected));
        }
}

// More lights than a block holds, of all kinds: each has the shadows it has alone.
TEST(ShadowLights, AnyNumber) {
    Scene scene = two_boxes();
    for (int i = 0; i < 80; ++i) {
        const float a = 0.3f * float(i);
        Light light = i % 3 == 0 ? directional(Vec3(std::cos(a), std::sin(a), -1))
                                 : point(Vec3(2 * std::cos(a), 2 * std::sin(a), i % 3 == 1 ? 4.0f : 0.3f));
        light.casts_shadows = i % 7 != 0;
        scene.set_light(std::to_string(i), light);
    }
    expect_sum(scene, 64);
}

// Maps of 16 MB each, six for each light: more than are kept. They are drawn in turns, and the picture is the
// same.
TEST(ShadowLights, MoreThanMemoryHolds) {
    Scene scene = two_boxes();
    for (int i = 0; i < 6; ++i)
        scene.set_light(std::to_string(i), point(Vec3(-1.5f + 0.6f * float(i), 0.5f, 0.3f)));
    expect_sum(scene, 2048);
}

}  // namespace
}  // namespace easypbr::shadow_maps_test
