#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "io/bytes.h"
#include "io/temporary_folder.h"

namespace easypbr::kitti_test {

namespace {

std::string scan(int points) {
    Bytes bytes;
    for (int i = 0; i < points; ++i) bytes.add_all({float(i), 2.0f, 3.0f, 0.25f * float(i)});
    return bytes.str();
}

std::string labels(std::initializer_list<uint32_t> values) {
    return Bytes().add_all(values).str();
}

}  // namespace

TEST(Kitti, ReadsScansWithoutLabels) {
    const TemporaryFolder folder;
    write_file(folder / "000000.bin", scan(3));
    const auto mesh = Mesh(folder / "000000.bin").snapshot();
    ASSERT_EQ(mesh->V.rows(), 3);
    EXPECT_EQ(Vec3(mesh->V.row(2)), Vec3(2, 2, 3));
    EXPECT_EQ(mesh->I[2], 0.5f);
    EXPECT_TRUE(mesh->L.empty());
    EXPECT_EQ(mesh->label_map, nullptr);
}

TEST(Kitti, ReadsScansOfNuScenes) {
    const TemporaryFolder folder;
    const fs::path path = folder / "LIDAR_TOP__1532402927647951.pcd.bin";
    Bytes bytes;
    // 4 points of 20 bytes are 5 of 16, too: the name tells.
    for (int i = 0; i < 4; ++i) bytes.add_all({float(i), 2.0f, 3.0f, 10.0f * float(i), float(31 - i)});
    write_file(path, bytes.str());
    const auto mesh = Mesh(path).snapshot();
    ASSERT_EQ(mesh->V.rows(), 4);
    EXPECT_EQ(Vec3(mesh->V.row(3)), Vec3(3, 2, 3));
    EXPECT_EQ(mesh->I[3], 30);
    EXPECT_EQ(scalar_named(*mesh, "ring").values[3], 28);

    write_file(path, scan(3));
    try {
        Mesh mesh_of_kitti(path);
        ADD_FAILURE() << "was read";
    } catch (const FormatError& error) {
        EXPECT_NE(std::string(error.what()).find("48 bytes are not a multiple of 20"), std::string::npos)
            << error.what();
    }
}

TEST(Kitti, FindsTheLabels) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "00/velodyne");
    fs::create_directories(folder / "00/labels");
    write_file(folder / "00/velodyne/000007.bin", scan(3));
    // Instance in the upper half, class in the lower one.
    write_file(folder / "00/labels/000007.label", labels({40, 10 | 5u << 16, 259 | 65535u << 16}));
    const auto mesh = Mesh(folder / "00/velodyne/000007.bin").snapshot();
    ASSERT_EQ(mesh->L.rows(), 3);
    EXPECT_EQ(mesh->L[0], 40);
    EXPECT_EQ(mesh->L[1], 10);
    EXPECT_EQ(mesh->L[2], 259);
    EXPECT_EQ(scalar_named(*mesh, "instance").values[1], 5);
    EXPECT_EQ(scalar_named(*mesh, "instance").values[2], 65535);
    ASSERT_NE(mesh->label_map, nullptr);
    EXPECT_EQ(mesh->label_map->find(40)->name, "road");

    write_file(folder / "alone.bin", scan(2));
    write_file(folder / "alone.label", labels({1, 10}));
    const auto alone = Mesh(folder / "alone.bin").snapshot();
    EXPECT_EQ(alone->L[1], 10);
    EXPECT_TRUE(alone->scalars.empty()) << "no instances, nothing to say about them";
}

TEST(Kitti, KeepsLabelsWithTheirPoints) {
    const TemporaryFolder folder;
    write_file(folder / "a.bin", Bytes().add_all({NAN, 0.0f, 0.0f, 0.0f, 1.0f, 2.0f, 3.0f, 4.0f}).str());
    write_file(folder / "a.label", labels({10, 40}));
    const auto mesh = Mesh(folder / "a.bin").snapshot();
    ASSERT_EQ(mesh->V.rows(), 1);
    EXPECT_EQ(mesh->L[0], 40);
}

TEST(Kitti, ShowsForeignLabelsWithoutTheMap) {
    const TemporaryFolder folder;
    write_file(folder / "a.bin", scan(2));
    write_file(folder / "a.label", labels({10, 12345}));
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    const auto mesh = Mesh(folder / "a.bin").snapshot();
    set_log_sink({});
    EXPECT_EQ(mesh->L[1], 12345);
    EXPECT_EQ(mesh->label_map, nullptr);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("12345"), std::string::npos);
}

TEST(Kitti, RefusesLabelsOfAnotherLength) {
    const TemporaryFolder folder;
    write_file(folder / "a.bin", scan(3));
    write_file(folder / "a.label", labels({10, 40}));
    try {
        Mesh mesh(folder / "a.bin");
        ADD_FAILURE() << "was read";
    } catch (const FormatError& error) {
        EXPECT_NE(std::string(error.what()).find("a.label: 3 labels of 4 bytes expected"), std::string::npos)
            << error.what();
    }
}

}  // namespace easypbr::kitti_test
