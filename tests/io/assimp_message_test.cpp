// Whatever the assimp reader answers, it gives a scene or a FormatError.
#include "easypbr/io/mesh/assimp/message.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "easypbr/core/error.h"
#include "easypbr/io/mesh/assimp/message_decoder.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh.h"
#include "io/fuzz.h"

namespace easypbr::io::assimp_message_test {
namespace {

constexpr uint64_t memory = 1 << 20;

/// A message written by hand after the description in assimp/message.h.
class Message {
  public:
    template <class T>
    Message& put(const T& value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
        return *this;
    }
    Message& text(std::string_view text) {
        put(uint64_t(text.size()));
        bytes_ += text;
        return *this;
    }
    Message& node(std::string_view name) {
        text(name);
        for (const float value : {1, 0, 0, 10, 0, 1, 0, 20, 0, 0, 1, 30}) put(value);
        return *this;
    }
    std::string finished(MessageKind kind = MessageKind::scene, uint32_t version = message_version) const {
        MessageHeader header;
        header.kind = kind;
        header.version = version;
        header.size = sizeof(header) + bytes_.size();
        return std::string(reinterpret_cast<const char*>(&header), sizeof(header)) + bytes_;
    }

  private:
    std::string bytes_;
};

/// An image of 2 x 1 pixels, a material with it, a node with a triangle, a line and an empty child.
Message small_scene(int third_index = 2) {
    Message out;
    out.put(uint64_t(1)).put(MessageImage::pixels).put(2u).put(1u).put(std::array<uint8_t, 8>{1, 2, 3, 4});
    out.put(uint64_t(1)).text("wood").put(MessageFactors{{0.1f, 0.2f, 0.3f}, 1, 0, 0.25f, {0, 0, 0}, 1});
    out.put(uint8_t(1)).put(MessageTexture::embedded).put(uint8_t(2)).put(uint8_t(1)).put(0u).text("*0");
    for (int slot = 1; slot < material_slots; ++slot) out.put(uint8_t(0));
    out.node("root").put(uint64_t(3)).put(uint8_t(message_uvs));
    out.put(std::array<float, 9>{0, 0, 0, 1, 0, 0, 0, 1, 0}).put(std::array<float, 6>{0, 0, 1, 0, 0, 1});
    out.put(uint64_t(1)).put(std::array{0, 1, third_index}).put(uint64_t(1)).put(std::array{0, 1});
    out.put(uint64_t(1)).put(0u).put(uint64_t(1)).text("part").put(std::array{0, 1, 0});
    out.put(uint64_t(1)).node("child").put(uint64_t(0)).put(uint8_t(0));
    for (int count = 0; count < 5; ++count) out.put(uint64_t(0));
    return out;
}

Mesh decoded(const std::string& message, uint64_t budget = memory) {
    return decode_scene(std::as_bytes(std::span(message)), "folder/model.ase", budget).mesh;
}

std::string error_of(const std::string& message) {
    try {
        decoded(message);
    } catch (const FormatError& error) {
        return error.what();
    }
    return "none";
}

TEST(AssimpMessage, GivesTheScene) {
    const Mesh root = decoded(small_scene().finished());
    EXPECT_EQ(root.name(), "model");
    const auto data = root.snapshot()->children.at(0).snapshot();
    EXPECT_EQ(data->name, "root");
    EXPECT_EQ(data->T_parent_mesh.translation(), Vec3d(10, 20, 30));
    EXPECT_EQ(data->V.row(1), Eigen::RowVector3f(1, 0, 0));
    EXPECT_EQ(data->UV.row(2), Eigen::RowVector2f(0, 1));
    EXPECT_EQ(data->F.row(0), Eigen::RowVector3i(0, 1, 2));
    EXPECT_EQ(data->E.row(0), Eigen::RowVector2i(0, 1));
    EXPECT_TRUE(data->N.empty() && data->C.empty());
    EXPECT_EQ(data->parts.at(0).name, "part");
    EXPECT_EQ(data->children.at(0).name(), "child");
    const Material& material = data->materials.at(0);
    EXPECT_EQ(material.name, "wood");
    EXPECT_EQ(material.base_color, Vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(material.roughness, 0.25f);
    EXPECT_EQ(material.base_color_texture.wrap_u, Wrap::clamp);
    EXPECT_EQ(material.base_color_texture.wrap_v, Wrap::mirror);
    ASSERT_TRUE(material.base_color_texture);
    EXPECT_EQ(material.base_color_texture.image->at<uint8_t>(0, 0)[2], 3);
}

TEST(AssimpMessage, IsRefusedWhenItLies) {
    EXPECT_NE(error_of(small_scene(3).finished()).find("cannot read folder/model.ase"), std::string::npos);
    EXPECT_NE(error_of(small_scene(-1).finished()), "none");
    EXPECT_NE(error_of(Message().put(~uint64_t(0)).finished()).find("count"), std::string::npos);
    EXPECT_NE(error_of(small_scene().put(0).finished()).find("after its end"), std::string::npos);
    EXPECT_NE(error_of(small_scene().finished(MessageKind::scene, 999)).find("version"), std::string::npos);
    EXPECT_NE(error_of(small_scene().finished(MessageKind::extensions)).find("kind"), std::string::npos);
    EXPECT_NE(error_of("").find("without an answer"), std::string::npos);
    EXPECT_EQ(error_of(Message().text("bad").finished(MessageKind::error)),
              "cannot read folder/model.ase: bad");
}

// Each index of four bytes becomes a material of some kilobytes.
TEST(AssimpMessage, TakesNoMoreMemoryThanItMay) {
    Message message;
    message.put(uint64_t(0)).put(uint64_t(0)).node("root").put(uint64_t(0)).put(uint8_t(0));
    message.put(uint64_t(0)).put(uint64_t(0)).put(uint64_t(100'000));
    for (uint32_t i = 0; i < 100'000; ++i) message.put(i);
    message.put(uint64_t(0)).put(uint64_t(0));
    EXPECT_NE(error_of(message.finished()).find("memory"), std::string::npos);
}

// Nodes within nodes without end would take the stack.
TEST(AssimpMessage, IsNotTooDeep) {
    Message message;
    message.put(uint64_t(0)).put(uint64_t(0));
    for (int depth = 0; depth < 3000; ++depth) {
        message.node("n").put(uint64_t(0)).put(uint8_t(0));
        for (int count = 0; count < 4; ++count) message.put(uint64_t(0));
        message.put(uint64_t(depth < 2999));
    }
    const std::string text = message.finished();
    EXPECT_THROW(decoded(text, uint64_t(1) << 30), FormatError);
}

TEST(AssimpMessage, IsRefusedWhenCutOff) {
    const std::string good = small_scene().finished();
    for (size_t size = 0; size < good.size(); ++size) {
        std::string cut = good.substr(0, size);
        EXPECT_THROW(decoded(cut), FormatError) << size;
        if (size < sizeof(MessageHeader)) continue;
        // One that claims to be complete, so that the content has to be looked at.
        const uint64_t claimed = size;
        std::memcpy(cut.data() + offsetof(MessageHeader, size), &claimed, sizeof(claimed));
        EXPECT_THROW(decoded(cut), FormatError) << size;
    }
}

TEST(AssimpMessage, SurvivesEachBit) {
    const std::string good = small_scene().finished();
    for (size_t bit = 0; bit < 8 * good.size(); ++bit) {
        std::string bad = good;
        bad[bit / 8] = char(bad[bit / 8] ^ (1 << bit % 8));
        try {
            decoded(bad);
        } catch (const FormatError&) {
        }
    }
}

TEST(AssimpMessage, SurvivesMutation) {
    fuzz(small_scene().finished(), [](std::string message) {
        if (message.size() >= sizeof(MessageHeader)) {
            const MessageHeader header{message_magic, message_version, MessageKind::scene, message.size()};
            std::memcpy(message.data(), &header, sizeof(header));
        }
        decoded(message);
    });
}

}  // namespace
}  // namespace easypbr::io::assimp_message_test
