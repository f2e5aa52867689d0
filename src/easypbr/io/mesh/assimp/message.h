// The binary form in which the assimp reader, a program of its own, answers to libeasypbr. It is private to
// one build of both: numbers as this machine holds them.
//
//   scene       embedded images: count, then of each its MessageImage; 0: size, bytes of a compressed image;
//                 1: width, height (u32), RGBA of each pixel
//               materials: count, then of each its name, MessageFactors, and for each of the material_slots a
//                 count (u8) and MessageTexture, wrap of u and v (u8), image (u32) or file name of each
//               root node
//   node        name, the first 3 rows of T_parent_mesh (12 f32), number of vertices, MessageArrays (u8) that
//                 follow V, these arrays in the order V, N, UV, C (f32), F (count, i32), E (count, i32),
//                 materials: count, index of each (u32; beyond the materials: a default one),
//                 parts: count, then of each name, first face, faces, material of this node (i32),
//                 children: count, nodes
//   extensions  count, then each
//   error       text
//
// Counts and sizes are u64; texts are their size and bytes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace easypbr::io {

inline constexpr uint64_t message_magic = 0x706d697373616265;
inline constexpr uint32_t message_version = 1;

enum class MessageKind : uint32_t { scene = 1, extensions = 2, error = 3 };

/// Stands before the rest, and is written last: what has one is complete.
struct MessageHeader {
    uint64_t magic = message_magic;
    uint32_t version = message_version;
    MessageKind kind = MessageKind::error;
    uint64_t size = 0;  ///< of the whole message, bytes
};

enum class MessageImage : uint8_t { compressed = 0, pixels = 1 };
enum class MessageTexture : uint8_t { file = 0, embedded = 1 };
enum MessageArrays : uint8_t { message_normals = 1, message_uvs = 2, message_colors = 4 };

/// As in Material.
struct MessageFactors {
    float base_color[3];
    float opacity;
    float metallic;
    float roughness;
    float emissive[3];
    uint32_t double_sided;
};

/// Base colour, metallic, roughness, normal, occlusion, emissive, opacity.
inline constexpr int material_slots = 7;

/// Where the reader finds what it writes to.
inline constexpr int message_descriptor = 3;

/// How the reader ends, besides by a signal.
enum ReaderExit { reader_done = 0, reader_misused = 2, reader_out_of_memory = 3 };

}  // namespace easypbr::io
