#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/archive/lzf.h"
#include "easypbr/io/mesh/cloud_reader.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/pcd/pcd_header.h"

namespace easypbr::io {
namespace {

std::vector<Property> properties_of_field(const PcdField& field) {
    std::vector<Property> properties;
    for (std::string& name : names_of_parts(field.name, field.count))
        properties.push_back({std::move(name), field.type, {}, 1, 0});
    return properties;
}

/// One element: a point's fields stand together.
Element points_of(const PcdHeader& header) {
    Element points{"point", header.points, {}};
    for (const PcdField& field : header.fields)
        for (Property& property : properties_of_field(field))
            points.properties.push_back(std::move(property));
    return points;
}

/// An element for each field: its values of all points stand together.
std::vector<Element> elements_by_field(const PcdHeader& header) {
    std::vector<Element> elements;
    for (const PcdField& field : header.fields)
        if (field.count > 0) elements.push_back({"point", header.points, properties_of_field(field)});
    return elements;
}

uint32_t read_size(const char* p) {
    uint32_t size;
    std::memcpy(&size, p, sizeof size);
    return size;
}

[[noreturn]] void fail_damaged(const Source& source, std::string_view data) {
    fail_at_byte(source, data.data(), "the compressed data are damaged");
}

MeshData read_at_once(const Source& source, std::string_view data, size_t size,
                      std::vector<Element> elements) {
    charge_memory(size, "its points");
    const auto bytes = std::make_unique_for_overwrite<char[]>(size);
    if (!lzf_decompress(data, {bytes.get(), size})) fail_damaged(source, data);
    source.release_until(source.end());
    return read_binary_cloud(source, {{Source(std::string_view(bytes.get(), size), source.path), bytes.get(),
                                       std::endian::little, std::move(elements)}});
}

/// Decompresses a piece while the one before is being read: one thread is busy with the one, the others with
/// the other, and both stay in the processor's caches.
class PieceReader {
  public:
    PieceReader(const Source& source, std::string_view data, size_t size, std::vector<Element> elements)
        : source_(source), data_(data), left_(size), decoder_(data), stream_(source, std::move(elements)) {
        for (Piece& piece : pieces_) {
            piece.bytes = std::make_unique_for_overwrite<char[]>(capacity);
            piece.begin = piece.end = piece.bytes.get() + LzfDecoder::history;
        }
    }

    MeshData read() {
        fill(pieces_[0], nullptr);
        for (size_t i = 0; pieces_[i % 2].begin != pieces_[i % 2].end; ++i) {
            Piece &now = pieces_[i % 2], &next = pieces_[(i + 1) % 2];
            parallel_for(2, 1, [&](size_t task) { task == 0 ? fill(next, &now) : consume(now); });
            if (!good_) break;
        }
        if (!good_ || left_ > 0 || !decoder_.at_end()) fail_damaged(source_, data_);
        return stream_.finish();
    }

  private:
    static constexpr size_t piece_size = 1 << 21;
    static constexpr size_t capacity = LzfDecoder::history + piece_size + LzfDecoder::overshoot;

    /// What was decoded last, behind the history before it.
    struct Piece {
        std::unique_ptr<char[]> bytes;
        char* begin;
        char* end;
    };

    void fill(Piece& piece, const Piece* before) {
        const char* known = piece.begin = piece.end = piece.bytes.get() + LzfDecoder::history;
        if (before) {
            const size_t kept = std::min(LzfDecoder::history, decoded_);
            known = piece.begin - kept;
            std::memcpy(piece.begin - kept, before->end - kept, kept);
        }
        char* end = piece.begin + std::min(left_, piece_size + LzfDecoder::overshoot);
        const char* aim = left_ > piece_size ? piece.begin + piece_size : end + 1;
        if (!decoder_.decode(known, piece.end, aim, end)) good_ = false;
        decoded_ += size_t(piece.end - piece.begin);
        left_ -= size_t(piece.end - piece.begin);
    }

    /// A row that a piece ends within is read with the next one, which has it in its history.
    void consume(const Piece& piece) {
        const char* begin = piece.begin - unread_;
        const size_t size = size_t(piece.end - begin);
        unread_ = size - stream_.push(begin, size);
    }

    const Source& source_;
    const std::string_view data_;
    size_t left_, decoded_ = 0, unread_ = 0;
    bool good_ = true;
    LzfDecoder decoder_;
    CloudStream stream_;
    std::array<Piece, 2> pieces_;
};

MeshData read_compressed(const Source& source, const PcdHeader& header) {
    constexpr size_t sizes = 8;
    const size_t left = size_t(source.end() - header.body);
    if (left < sizes) fail(source, "truncated: the sizes of the compressed data are missing");
    const size_t compressed = read_size(header.body), full = read_size(header.body + 4);
    size_t row = 0;
    for (const PcdField& field : header.fields) row += field.size();
    if (compressed > left - sizes)
        fail_at_byte(source, header.body,
                     fmt::format("truncated: {} bytes of compressed data expected, {} are left", compressed,
                                 left - sizes));
    if (full != header.points * row || full > lzf_largest_size(compressed))
        fail_at_byte(source, header.body + 4,
                     fmt::format("{} points of {} bytes expected, but {} bytes were compressed to {}",
                                 header.points, row, full, compressed));
    const std::string_view data(header.body + sizes, compressed);
    std::vector<Element> elements = elements_by_field(header);
    if (CloudStream::can_read(elements)) return PieceReader(source, data, full, std::move(elements)).read();
    return read_at_once(source, data, full, std::move(elements));
}

MeshData read_points(const Source& source, const PcdHeader& header) {
    switch (header.data) {
        case PcdData::ascii:
            return read_text_cloud(source, TextRows(source, header.body, {.comment = '#'}),
                                   points_of(header));
        case PcdData::binary:
            return read_binary_cloud(source,
                                     {{source, header.body, std::endian::little, {points_of(header)}}});
        case PcdData::binary_compressed:
            break;
    }
    return read_compressed(source, header);
}

/// Depth images are in their camera's frame, y down and z forward; what lidars and surveys measure has z up.
bool is_depth_image(const PcdHeader& header, const MeshData& mesh) {
    return header.rows > 1 && !mesh.V.empty() && mesh.V.col(2).minCoeff() + mesh.offset.z() > 0;
}

}  // namespace

MeshData read_pcd(const Source& given) {
    if (given.bytes.empty()) fail(given, "the file is empty");
    const Source source = given.without_mark();
    const PcdHeader header = parse_pcd_header(source);
    MeshData mesh = read_points(source, header);
    drop_points_without_position(source, mesh);
    mesh.up = Vec3d::UnitZ();
    if (is_depth_image(header, mesh)) {
        mesh.up = -Vec3d::UnitY();
        mesh.front = -Vec3d::UnitZ();
    }
    return mesh;
}

}  // namespace easypbr::io
