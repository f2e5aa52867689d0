#include <cmath>
#include <string>

#include "easypbr/io/mesh/mesh_readers.h"
#include "io/las_builder.h"

namespace easypbr::las_test {

namespace {

MeshData read(const std::string& bytes) {
    MeshData mesh = io::read_las(io::Source(std::string_view(bytes), "test.las"));
    validate(mesh);
    return mesh;
}

bool has_scalar(const MeshData& mesh, const std::string& name) {
    return std::ranges::any_of(mesh.scalars, [&](const ScalarArray& s) { return s.name == name; });
}

}  // namespace

TEST(Las, ReadsEveryVersionAndPointFormat) {
    for (int minor = 0; minor <= 4; ++minor)
        for (int format = 0; format <= (minor < 2 ? 1 : minor < 3 ? 3 : minor < 4 ? 5 : 10); ++format) {
            const MeshData mesh = read(LasBuilder{.minor_version = minor, .format = format}.text());
            const std::string what = fmt::format("1.{} format {}", minor, format);
            ASSERT_EQ(mesh.V.rows(), 3) << what;
            EXPECT_LT(mesh.V.cwiseAbs().maxCoeff(), 1) << what;
            for (int i = 0; i < 3; ++i) {
                const Vec3d p = mesh.offset + mesh.V.row(i).transpose().cast<double>();
                const Vec3d expected(691'000.125 + 0.001 * i, 5'335'000.25 - 0.001 * i, 520.5 + 0.002 * i);
                // Half the spacing of float32 numbers up to 1.
                EXPECT_LE((p - expected).cwiseAbs().maxCoeff(), std::exp2(-24.0)) << what;
                EXPECT_EQ(mesh.I[i], 1000 + i) << what;
                EXPECT_EQ(mesh.L[i], 2 + i) << what << ": without the flags in the byte";
                EXPECT_EQ(scalar_named(mesh, "return_number").values[i], 1 + i) << what;
                EXPECT_EQ(scalar_named(mesh, "number_of_returns").values[i], 3) << what;
                EXPECT_FLOAT_EQ(scalar_named(mesh, "scan_angle").values[i], float(6 * i)) << what;
                EXPECT_EQ(scalar_named(mesh, "point_source_id").values[i], 77) << what;
            }
            EXPECT_FALSE(has_scalar(mesh, "user_data")) << what << ": it is zero everywhere";
            EXPECT_EQ(mesh.label_map->find(2)->name, "ground") << what;
            const bool timed = format == 1 || format >= 3;
            EXPECT_EQ(has_scalar(mesh, "gps_time"), timed) << what;
            if (timed) {
                EXPECT_EQ(scalar_named(mesh, "gps_time").values[2], 2.5f) << what;
            }
            const bool colored =
                format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
            EXPECT_EQ(!mesh.C.empty(), colored) << what;
            if (colored) {
                // The codes 0xff00 and 0x7f80 of 65535.
                EXPECT_NEAR(mesh.C(1, 0), 65280 / 65535.0, 1e-7) << what;
                EXPECT_NEAR(mesh.C(1, 1), 32640 / 65535.0, 1e-7) << what;
                EXPECT_EQ(mesh.C(1, 2), 0) << what;
            }
            EXPECT_EQ(has_scalar(mesh, "near_infrared"), format == 8 || format == 10) << what;
        }
}

TEST(Las, TakesColorsOf8BitsForWhatTheyAre) {
    const MeshData mesh = read(LasBuilder{.format = 2, .full_color = 255}.text());
    EXPECT_NEAR(mesh.C(0, 0), 1, 1e-6);
    EXPECT_NEAR(mesh.C(0, 1), 127 / 255.0, 1e-6);
    EXPECT_TRUE(read(LasBuilder{.format = 2, .full_color = 0}.text()).C.empty())
        << "black everywhere: none were given";
}

TEST(Las, ReadsExtraBytes) {
    LasBuilder las{.minor_version = 4, .format = 6};
    las.extra_record = las_extra(4, "height", 0.01, 100) + las_extra(10, "error") + las_extra(0, "raw") +
                       las_extra(21, "wave");
    // int16, float64, and two of the three bytes of a deprecated triple.
    las.extra_bytes = Bytes().add(int16_t(-250)).add(0.125).add(uint16_t(9)).str();
    const MeshData mesh = read(las.text());
    EXPECT_FLOAT_EQ(scalar_named(mesh, "height").values[1], 97.5f);
    EXPECT_EQ(scalar_named(mesh, "error").values[2], 0.125f);
    EXPECT_FALSE(has_scalar(mesh, "wave_1"));
}

TEST(Las, ExtraBytesTakeNoPlaceOfStandardFields) {
    LasBuilder las{.minor_version = 4, .format = 3, .points = 1};
    // "gps_time" of a byte stands at the end: nothing is read behind it.
    las.extra_record = las_extra(3, "label") + las_extra(9, "alpha") + las_extra(1, "gps_time");
    las.extra_bytes = Bytes().add(uint16_t(100)).add(3.0f).add(uint8_t(7)).str();
    const MeshData mesh = read(las.text());
    EXPECT_EQ(mesh.L[0], 2);
    EXPECT_EQ(scalar_named(mesh, "label").values[0], 100);
    ASSERT_EQ(mesh.C.cols(), 3);
    EXPECT_NEAR(mesh.C(0, 0), 65280 / 65535.0, 1e-7);
    EXPECT_EQ(scalar_named(mesh, "alpha").values[0], 3);
    EXPECT_EQ(scalar_named(mesh, "gps_time_2").values[0], 7);
    // Normals have no standard field.
    las.extra_record = las_extra(9, "NormalX") + las_extra(9, "nx") + las_extra(9, "ny") + las_extra(9, "nz");
    las.extra_bytes = Bytes().add(5.0f).add(0.0f).add(0.0f).add(1.0f).str();
    EXPECT_EQ(Vec3(read(las.text()).N.row(0)), Vec3(0, 0, 1));
}

TEST(Las, ValuesOfExtraBytesThatStandForNoneAreNaN) {
    LasBuilder las{.minor_version = 4, .format = 6};
    las.extra_record = las_extra(4, "height", 0.01, 100, Bytes().add(int64_t(-9999)).str()) +
                       las_extra(9, "depth", 0, 0, Bytes().add(-1.0).str()) +
                       las_extra(1, "echo", 0, 0, Bytes().add(uint64_t(255)).str());
    las.extra_bytes = Bytes().add(int16_t(-9999)).add(-1.0f).add(uint8_t(254)).str();
    const MeshData mesh = read(las.text());
    EXPECT_TRUE(std::isnan(scalar_named(mesh, "height").values[0]));
    EXPECT_TRUE(std::isnan(scalar_named(mesh, "depth").values[0]));
    EXPECT_EQ(scalar_named(mesh, "echo").values[0], 254);
}

TEST(Las, ReadsPointsNearZeroAsTheyAre) {
    const MeshData mesh = read(LasBuilder{.offset = {0, 0, 0}}.text());
    EXPECT_EQ(mesh.offset, Vec3d::Zero());
    EXPECT_FLOAT_EQ(mesh.V(0, 2), 20.5f);
}

}  // namespace easypbr::las_test
