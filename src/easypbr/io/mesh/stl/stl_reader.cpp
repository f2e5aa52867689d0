#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <numeric>

#include "easypbr/core/ascii.h"
#include "easypbr/core/log.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/source/text_scanner.h"
#include "easypbr/io/tables/polygons.h"
#include "easypbr/scene/crease.h"

namespace easypbr::io {
namespace {

constexpr size_t header_bytes = 84;
constexpr size_t facet_bytes = 50;
constexpr size_t stl_grain = 1 << 15;
constexpr size_t stl_chunk_bytes = 1 << 20;

/// Positions of triangle corners, three floats each.
using Corners = Eigen::VectorXf;

/// Room for the corners, of which three make a face.
Corners make_corners(size_t numbers) {
    charge_memory(uint64_t(numbers) * sizeof(float) + uint64_t(numbers) / 3 * sizeof(int32_t), "its facets");
    return Corners(Eigen::Index(numbers));
}

size_t declared_facets(const Source& source) {
    if (source.bytes.size() < header_bytes) return 0;
    uint32_t count = 0;
    std::memcpy(&count, source.begin() + 80, sizeof count);
    return count;
}

bool starts_with_word(const char* p, const char* end, std::string_view word) {
    p = skip_blanks(p, end);
    return size_t(end - p) >= word.size() && ascii::same_letters({p, word.size()}, word);
}

/// Binary files may begin with "solid" as well: the size decides, and then that text has no null bytes, as
/// those of the count and of the first facet, where bytes follow the facets or facets are missing.
bool is_text_stl(const Source& source) {
    if (source.bytes.size() == header_bytes + facet_bytes * declared_facets(source)) return false;
    if (source.bytes.substr(0, header_bytes + facet_bytes).find('\0') != std::string_view::npos) return false;
    const Source text = source.without_mark();
    return starts_with_word(text.begin(), text.end(), "solid");
}

/// Colours of facets are in their last two bytes: by bit 15 in files of VisCAM and SolidView, by the header
/// in those of Materialise Magics.
bool has_color(const char* facet) {
    return (facet[facet_bytes - 1] & 0x80) != 0;
}

bool header_has_color(const Source& source) {
    return source.bytes.substr(0, 80).find("COLOR=") != std::string_view::npos;
}

Corners read_binary(const Source& source) {
    const size_t count = declared_facets(source);
    if (source.bytes.size() < header_bytes || count > (source.bytes.size() - header_bytes) / facet_bytes)
        fail(source, fmt::format("truncated: {} facets take {} bytes, but the file has {}", count,
                                 header_bytes + facet_bytes * count, source.bytes.size()));
    if (count > INT32_MAX / 3) fail(source, "more facets than a mesh can hold");
    Corners corners = make_corners(count * 9);
    Progress progress(source, source.bytes.size());
    std::atomic<bool> is_colored = header_has_color(source);
    parallel_chunks(count, stl_grain, [&](size_t begin, size_t end) {
        bool any = false;
        for (size_t i = begin; i < end; ++i) {
            const char* const facet = source.begin() + header_bytes + i * facet_bytes;
            std::memcpy(corners.data() + i * 9, facet + 12, 36);
            any = any || has_color(facet);
        }
        if (any) is_colored = true;
        progress.advance((end - begin) * facet_bytes);
    });
    if (is_colored) log_warning(fmt::format("{}: colours of facets are left out", source.path.string()));
    return corners;
}

/// Pieces of about `stl_chunk_bytes` that begin with a line "facet ...".
std::vector<size_t> facet_chunks(const Source& source) {
    std::vector<size_t> starts = line_chunks(source.bytes, stl_chunk_bytes);
    for (size_t i = 1; i + 1 < starts.size(); ++i) {
        const char* p = source.begin() + std::max(starts[i], starts[i - 1]);
        while (p != source.end() && !starts_with_word(p, source.end(), "facet"))
            p = next_line(p, source.end());
        starts[i] = size_t(p - source.begin());
    }
    return starts;
}

/// Corners of the facets in [p, end); a facet must have three, and end.
std::vector<float> read_facets(const Source& source, const char* p, const char* end) {
    std::vector<float> corners;
    size_t in_facet = 0;
    bool is_open = false;
    for (; p != end; p = next_line(p, end)) {
        if (starts_with_word(p, end, "facet")) {
            if (is_open) fail_at_line(source, p, "a facet begins inside another");
            is_open = true;
        } else if (starts_with_word(p, end, "vertex")) {
            const char* line = p;
            read_word(p, end);
            for (int k = 0; k < 3; ++k) {
                corners.emplace_back();
                if (!read_number(p, end, corners.back()))
                    fail_at_line(source, line, "'vertex' needs three numbers");
            }
            ++in_facet;
        } else if (starts_with_word(p, end, "endfacet")) {
            if (in_facet != 3)
                fail_at_line(source, p, fmt::format("a facet has {} vertices, expected 3", in_facet));
            in_facet = 0;
            is_open = false;
        }
    }
    if (is_open || in_facet != 0)
        fail_at_line(source, end,
                     end == source.end() ? "the file ends inside a facet" : "a facet begins inside another");
    return corners;
}

/// Scripts leave out the last line, so that the facets before it are whole; a file that has been cut off
/// rarely ends behind one.
void warn_of_missing_end(const Source& source) {
    const size_t last = source.bytes.find_last_not_of(" \t\r\n\v\f");
    if (last == std::string_view::npos) return;
    const size_t feed = source.bytes.rfind('\n', last);
    const char* const line = source.begin() + (feed == std::string_view::npos ? 0 : feed + 1);
    if (!starts_with_word(line, source.end(), "endsolid"))
        log_warning(fmt::format("{}: 'endsolid' is missing at the end; the file may have been cut off",
                                source.path.string()));
}

Corners read_text(const Source& given) {
    const TextSource text(given);
    const Source& source = text.source();
    const std::vector<size_t> starts = facet_chunks(source);
    std::vector<std::vector<float>> parts(starts.size() - 1);
    Progress progress(source, source.bytes.size());
    parallel_for(parts.size(), 1, [&](size_t i) {
        parts[i] = read_facets(source, source.begin() + starts[i], source.begin() + starts[i + 1]);
        progress.advance(starts[i + 1] - starts[i]);
    });
    std::vector<size_t> begin{0};
    for (const auto& part : parts) begin.push_back(begin.back() + part.size());
    if (begin.back() / 3 > INT32_MAX) fail(source, "more facets than a mesh can hold");
    Corners corners = make_corners(begin.back());
    parallel_for(parts.size(), 1,
                 [&](size_t i) { std::copy(parts[i].begin(), parts[i].end(), corners.data() + begin[i]); });
    warn_of_missing_end(source);
    return corners;
}

/// Makes one vertex of all corners at exactly the same position, in the order of their first appearance.
void weld(Corners&& corners, MeshData& mesh) {
    const size_t count = size_t(corners.size()) / 3;
    // Adding zero makes -0 and 0 the same.
    parallel_for(size_t(corners.size()), stl_grain, [&](size_t i) { corners[Eigen::Index(i)] += 0.0f; });
    Array3i::Dense F(Eigen::Index(count / 3), 3);
    auto* remap = reinterpret_cast<unsigned*>(F.data());
    const size_t vertices =
        meshopt_generateVertexRemap(remap, nullptr, count, corners.data(), count, 3 * sizeof(float));
    charge_memory(uint64_t(vertices) * 3 * sizeof(float), "its vertices");
    Array3f::Dense V(Eigen::Index(vertices), 3);
    meshopt_remapVertexBuffer(V.data(), corners.data(), count, 3 * sizeof(float), remap);
    mesh.V = std::move(V);
    mesh.F = std::move(F);
}

}  // namespace

namespace {

/// Without a value of the user.
constexpr float stl_crease_deg = 30;

}  // namespace

MeshData read_stl(const Source& source, const LoadOptions& options) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    Corners corners = is_text_stl(source) ? read_text(source) : read_binary(source);
    if (corners.size() == 0) fail(source, "no facets");
    MeshData mesh;
    weld(std::move(corners), mesh);
    check_positions(source, mesh.V);
    split_creases(mesh, options.crease_angle_deg.value_or(stl_crease_deg));
    return mesh;
}

}  // namespace easypbr::io
