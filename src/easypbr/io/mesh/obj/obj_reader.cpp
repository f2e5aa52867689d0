#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <set>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/obj/mtl_reader.h"
#include "easypbr/io/mesh/obj/obj_chunk.h"
#include "easypbr/io/source/text_scanner.h"
#include "easypbr/io/tables/attributes.h"
#include "easypbr/scene/color_range.h"
#include "easypbr/scene/crease.h"

namespace easypbr::io {
namespace {

constexpr size_t obj_chunk_bytes = 1 << 20;
constexpr size_t obj_slab = 64;  ///< chunks after which the memory of the text before is given back
constexpr size_t obj_grain = 1 << 15;

/// Whether the line feed before `place` is continued by a backslash.
bool is_continued(std::string_view text, size_t place) {
    size_t i = place - 1;
    while (i > 0 && is_blank(text[i - 1])) --i;
    return i > 0 && text[i - 1] == '\\';
}

std::vector<size_t> obj_chunk_starts(std::string_view text) {
    const char* end = text.data() + text.size();
    std::vector<size_t> starts = line_chunks(text, obj_chunk_bytes);
    for (size_t i = 1; i + 1 < starts.size(); ++i) {
        starts[i] = std::max(starts[i], starts[i - 1]);
        while (starts[i] < text.size() && is_continued(text, starts[i]))
            starts[i] = size_t(next_line(text.data() + starts[i], end) - text.data());
    }
    return starts;
}

std::vector<ObjChunk> parse_chunks(const Source& source, const Vec3d& offset) {
    const std::vector<size_t> starts = obj_chunk_starts(source.bytes);
    std::vector<ObjChunk> chunks(starts.size() - 1);
    Progress progress(source, source.bytes.size());
    for (size_t first = 0; first < chunks.size(); first += obj_slab) {
        parallel_for(std::min(obj_slab, chunks.size() - first), 1, [&](size_t k) {
            const size_t i = first + k;
            chunks[i] =
                parse_obj_chunk(source, source.bytes.substr(starts[i], starts[i + 1] - starts[i]), offset);
            progress.advance(starts[i + 1] - starts[i]);
        });
        // How much lines hold is known when they are read: no more than a slab is read beyond the limit.
        size_t bytes = 0;
        for (size_t i = first; i < std::min(first + obj_slab, chunks.size()); ++i)
            bytes += chunks[i].byte_count();
        charge_memory(bytes, "its vertices and faces");
        source.release_until(source.begin() + starts[first]);
    }
    return chunks;
}

/// Sums over the chunks before each chunk; the total at the end.
template <class Count>
std::vector<size_t> offsets(const std::vector<ObjChunk>& chunks, Count count) {
    std::vector<size_t> begin{0};
    for (const ObjChunk& chunk : chunks) begin.push_back(begin.back() + count(chunk));
    return begin;
}

/// Joins the chunks of one file.
class ObjReader {
  public:
    ObjReader(const Source& source, float crease_angle_deg)
        : source_(source),
          crease_angle_deg_(crease_angle_deg),
          offset_(choose_obj_offset(source)),
          chunks_(parse_chunks(source, offset_)) {}

    MeshData read() {
        join_vertices();
        join_faces();
        join_edges();
        warn_of_broken_lines();
        join_materials();
        chunks_ = {};
        check();
        attach_attributes();
        if (E_.size()) mesh_.E = std::move(E_);
        triangulate(std::move(faces_), mesh_);
        fill_missing_normals();
        if (mesh_.C.empty())
            for (Material& material : mesh_.materials)
                material.base_color_given &=
                    material.base_color_texture && material.base_color == Material().base_color;
        if (mesh_.materials.size() > 1) assign_materials(material_of_face_, mesh_);
        return std::move(mesh_);
    }

  private:
    template <class Matrix>
    void join_floats(std::vector<float> ObjChunk::*part, int width, Matrix& out) {
        const auto begin = offsets(chunks_, [&](const ObjChunk& c) { return (c.*part).size(); });
        if (begin.back() / size_t(width) > INT32_MAX) fail(source_, "more vertices than a mesh can hold");
        out.resize(Eigen::Index(begin.back()) / width, width);
        parallel_for(chunks_.size(), 1, [&](size_t i) {
            std::copy((chunks_[i].*part).begin(), (chunks_[i].*part).end(), out.data() + begin[i]);
            chunks_[i].*part = {};
        });
    }

    void join_vertices() {
        for (const ObjIndex kind : {obj_position, obj_uv, obj_normal})
            vertex_begin_[kind] = offsets(chunks_, [&](const ObjChunk& c) { return c.vertex_count(kind); });
        const bool colored =
            std::any_of(chunks_.begin(), chunks_.end(), [](const auto& c) { return !c.colors.empty(); });
        if (colored) {
            for (ObjChunk& chunk : chunks_) chunk.colors.resize(chunk.positions.size(), no_color);
            join_floats(&ObjChunk::colors, 3, C_);
            normalize_colors(C_);
            parallel_for(size_t(C_.size()), obj_grain, [&](size_t i) {
                if (std::isnan(C_.data()[i])) C_.data()[i] = 1;
            });
        }
        join_floats(&ObjChunk::positions, 3, V_);
        join_floats(&ObjChunk::uv, 2, uv_);
        join_floats(&ObjChunk::normals, 3, normals_);
        if (V_.rows() == 0) fail(source_, "no vertices: lines 'v x y z' expected");
    }

    /// Makes relative indices absolute; one before the first vertex becomes one that no check lets pass.
    void resolve(ObjIndices& indices, size_t base) const {
        for (const uint32_t i : indices.relative) {
            const int64_t index = indices.values[i] + int64_t(base);
            indices.values[i] = index >= 0 && index < INT32_MAX ? int32_t(index) : INT32_MAX;
        }
    }

    void join_faces() {
        const auto corner_begin =
            offsets(chunks_, [](const ObjChunk& c) { return c.corners[obj_position].values.size(); });
        if (corner_begin.back() > UINT32_MAX) fail(source_, "more face corners than are supported");
        faces_.values.resize(Eigen::Index(corner_begin.back()));
        join_corners(obj_position, corner_begin, faces_.values.data());
        const auto has = [&](ObjIndex kind) {
            return std::any_of(chunks_.begin(), chunks_.end(),
                               [&](const ObjChunk& c) { return !c.corners[kind].values.empty(); });
        };
        for (const ObjIndex kind : {obj_uv, obj_normal}) {
            if (!has(kind)) continue;
            attribute_[kind].resize(corner_begin.back(), no_index);
            join_corners(kind, corner_begin, attribute_[kind].data());
        }
        join_sizes(corner_begin);
    }

    void join_corners(ObjIndex kind, const std::vector<size_t>& corner_begin, int32_t* out) {
        parallel_for(chunks_.size(), 1, [&](size_t i) {
            ObjIndices& indices = chunks_[i].corners[kind];
            resolve(indices, vertex_begin_[kind][i]);
            std::copy(indices.values.begin(), indices.values.end(), out + corner_begin[i]);
        });
    }

    void join_sizes(const std::vector<size_t>& corner_begin) {
        face_begin_ = offsets(chunks_, [](const ObjChunk& c) { return c.face_sizes.size(); });
        faces_.rows = face_begin_.back();
        if (faces_.rows > INT32_MAX) fail(source_, "more faces than a mesh can hold");
        const bool triangles = std::all_of(chunks_.begin(), chunks_.end(), [](const ObjChunk& c) {
            return std::all_of(c.face_sizes.begin(), c.face_sizes.end(),
                               [](uint32_t size) { return size == 3; });
        });
        faces_.width = 3;
        if (triangles) return;
        faces_.first.assign(faces_.rows + 1, 0);
        parallel_for(chunks_.size(), 1, [&](size_t i) {
            size_t end = corner_begin[i];
            for (size_t k = 0; k < chunks_[i].face_sizes.size(); ++k)
                faces_.first[face_begin_[i] + k + 1] = uint32_t(end += chunks_[i].face_sizes[k]);
        });
    }

    void warn_of_broken_lines() const {
        size_t count = 0;
        const char* first = nullptr;
        for (const ObjChunk& chunk : chunks_) {
            if (!first) first = chunk.first_broken_line;
            count += chunk.broken_line_count;
        }
        if (count > 0)
            log_warning(fmt::format(
                "{}: 'l' needs at least 2 vertices, each v, v/t, v//n or v/t/n: left out{}",
                line_name(source_, first), count > 1 ? fmt::format(", {} such lines in all", count) : ""));
    }

    void join_edges() {
        const auto begin = offsets(chunks_, [](const ObjChunk& c) { return c.edges.values.size(); });
        E_.resize(Eigen::Index(begin.back() / 2), 2);
        for (size_t i = 0; i < chunks_.size(); ++i) {
            resolve(chunks_[i].edges, vertex_begin_[obj_position][i]);
            std::copy(chunks_[i].edges.values.begin(), chunks_[i].edges.values.end(), E_.data() + begin[i]);
        }
    }

    /// Numbers the materials in the order of their first face.
    void join_materials() {
        std::map<std::string, Material> library = load_libraries();
        std::map<std::string, int32_t> numbers;
        std::string current;
        size_t face = 0;
        const auto use_until = [&](size_t end) {
            if (face == end) return;
            const auto [known, is_new] = numbers.try_emplace(current, int32_t(numbers.size()));
            if (is_new) mesh_.materials.push_back(find_material(library, current));
            material_of_face_.resize(end, known->second);
            face = end;
        };
        for (size_t i = 0; i < chunks_.size(); ++i) {
            for (const auto& [place, name] : chunks_[i].materials) {
                use_until(face_begin_[i] + place);
                current = unquoted(name);
            }
        }
        use_until(faces_.rows);
    }

    /// Names may have comments behind them, and a '#' of their own, as "Material #25".
    Material find_material(const std::map<std::string, Material>& library, const std::string& name) const {
        if (const auto found = library.find(name); found != library.end()) return found->second;
        for (const auto& [key, material] : library)
            if (key == without_comment(name) || without_comment(key) == name) return material;
        if (!name.empty() && !library.empty())
            log_warning(fmt::format("{}: material '{}' is not defined, the default is used",
                                    source_.path.string(), name));
        Material material;
        material.name = name;
        return material;
    }

    /// The files of a line 'mtllib': all of it is one name, or there are several between blanks. The bare
    /// name of a whole line is the end of its last one: it counts where there are not several.
    std::vector<fs::path> libraries_of(const std::string& line) const {
        const fs::path folder = source_.path.parent_path();
        const fs::path whole = place_of_named_file(folder, line);
        for (const fs::path& path : {folder / line, whole})
            if (exists_in_scope(path)) return {path};
        std::vector<fs::path> paths;
        bool are_several = false, are_mtl = true;
        const std::string_view names = without_comment(line);
        const char* p = names.data();
        const char* const end = p + names.size();
        for (std::string name(read_word(p, end)); !name.empty(); name = read_word(p, end)) {
            const auto path = find_named_file({folder}, name);
            are_several = are_several || path;
            are_mtl = are_mtl && extension_of(name) == "mtl";
            paths.push_back(path ? *path : place_of_named_file(folder, name));
        }
        if (paths.size() > 1 && are_mtl) return paths;
        if (const auto path = find_named_file({folder}, line)) return {*path};
        if (are_several || are_mtl) return paths;
        return {whole};
    }

    std::map<std::string, Material> load_libraries() const {
        std::map<std::string, Material> library;
        TextureLoader textures(source_.path);
        std::set<std::string> lines;
        std::set<fs::path> read;
        for (const ObjChunk& chunk : chunks_)
            for (const std::string& line : chunk.libraries) {
                if (!lines.insert(line).second) continue;
                for (const fs::path& path : libraries_of(line))
                    if (read.insert(path).second) load_library(path, textures, library);
            }
        return library;
    }

    void load_library(const fs::path& path, TextureLoader& textures,
                      std::map<std::string, Material>& library) const {
        try {
            const FileBytes file(path);
            library.merge(read_mtl(Source(file, path), textures));
        } catch (const Error& error) {
            log_warning(fmt::format("{}: materials left out: {}", source_.path.string(), error.what()));
        }
    }

    void check() {
        const size_t count = size_t(V_.rows());
        check_positions(source_, V_);
        check_indices(source_, {faces_.values.data(), faces_.value_count()}, count, "a face", 1);
        check_indices(source_, {E_.data(), size_t(E_.size())}, count, "a line", 1);
        check_attribute(obj_uv, size_t(uv_.rows()), "texture coordinates");
        check_attribute(obj_normal, size_t(normals_.rows()), "normals");
        tidy_colors(C_);
        tidy_uv(uv_);
        tidy_normals(normals_);
    }

    void check_attribute(ObjIndex kind, size_t count, std::string_view what) const {
        std::atomic<bool> good{true};
        parallel_for(attribute_[kind].size(), obj_grain, [&](size_t i) {
            if (attribute_[kind][i] >= int64_t(count)) good = false;
        });
        if (good) return;
        const auto& indices = attribute_[kind];
        const int32_t bad =
            *std::find_if(indices.begin(), indices.end(), [&](int32_t i) { return i >= int64_t(count); });
        fail(source_,
             fmt::format("a face has index {} of {}, but there are {}", int64_t(bad) + 1, what, count));
    }

    /// Gives vertices the texture coordinates and normals of their corners; a vertex with several is
    /// repeated.
    void attach_attributes() {
        mesh_.V = std::move(V_);
        mesh_.offset = offset_;
        if (C_.size()) mesh_.C = std::move(C_);
        if (faces_.rows == 0) return attach_to_points();
        if (attribute_[obj_uv].empty() && attribute_[obj_normal].empty()) return;
        CornerSplit split;
        if (indices_agree()) {
            take_rows(
                size_t(mesh_.V.rows()), [](size_t i) { return int64_t(i); },
                [](size_t i) { return int64_t(i); });
            return;
        }
        split = split_corners({faces_.values.data(), faces_.value_count()}, corner_keys(),
                              size_t(mesh_.V.rows()));
        gather_vertices(split, mesh_);
        follow_split(split, {E_.data(), size_t(E_.size())});
        take_rows(
            split.key.size(), [&](size_t i) { return int64_t(int32_t(split.key[i] >> 32)); },
            [&](size_t i) { return int64_t(int32_t(split.key[i])); });
    }

    /// Of a cloud that has one of each for every point, in the same order.
    void attach_to_points() {
        const Eigen::Index count = mesh_.V.rows();
        if (normals_.rows() == count) N_ = std::move(normals_);
        if (uv_.rows() == count) mesh_.UV = std::move(uv_);
    }

    /// Whether every corner has one index for all that it has.
    bool indices_agree() const {
        std::atomic<bool> agree{true};
        for (const auto& attribute : attribute_)
            parallel_chunks(attribute.size(), obj_grain, [&](size_t begin, size_t end) {
                if (agree && !std::equal(attribute.begin() + ptrdiff_t(begin),
                                         attribute.begin() + ptrdiff_t(end), faces_.values.data() + begin))
                    agree = false;
            });
        return agree;
    }

    std::vector<uint64_t> corner_keys() const {
        std::vector<uint64_t> keys(faces_.value_count());
        const auto index = [&](ObjIndex kind, size_t corner) {
            return uint64_t(uint32_t(attribute_[kind].empty() ? no_index : attribute_[kind][corner]));
        };
        parallel_for(keys.size(), obj_grain,
                     [&](size_t c) { keys[c] = index(obj_uv, c) << 32 | index(obj_normal, c); });
        return keys;
    }

    /// Fills UV and N; an index without a row is 0 in UV and missing in N.
    template <class UvIndex, class NormalIndex>
    void take_rows(size_t count, UvIndex uv_index, NormalIndex normal_index) {
        if (!attribute_[obj_uv].empty()) {
            Array2f::Dense UV = Array2f::Dense::Zero(Eigen::Index(count), 2);
            parallel_for(count, obj_grain, [&](size_t i) {
                const int64_t row = uv_index(i);
                if (row >= 0 && row < uv_.rows()) UV.row(Eigen::Index(i)) = uv_.row(row);
            });
            mesh_.UV = std::move(UV);
        }
        if (attribute_[obj_normal].empty()) return;
        N_.setZero(Eigen::Index(count), 3);
        parallel_for(count, obj_grain, [&](size_t i) {
            const int64_t row = normal_index(i);
            if (row >= 0 && row < normals_.rows()) N_.row(Eigen::Index(i)) = normals_.row(row);
        });
    }

    /// Vertices of faces without normals in a file that has some get computed ones.
    void fill_missing_normals() {
        if (N_.size() == 0) return;
        const bool some_are_missing = (N_.rowwise().squaredNorm().array() == 0).any();
        mesh_.N = std::move(N_);
        if (some_are_missing) fill_normals(mesh_, crease_angle_deg_);
    }

    const Source& source_;
    const float crease_angle_deg_;
    const Vec3d offset_;
    std::vector<ObjChunk> chunks_;
    std::array<std::vector<size_t>, 3> vertex_begin_;
    std::vector<size_t> face_begin_;

    Array3f::Dense V_, normals_, N_;
    Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor> uv_;
    ArrayXf::Dense C_;
    Array2i::Dense E_;
    Polygons faces_;
    std::array<std::vector<int32_t>, 3> attribute_;  ///< per corner; that of positions stands in faces_
    std::vector<int32_t> material_of_face_;
    MeshData mesh_;
};

}  // namespace

MeshData read_obj(const Source& source, const LoadOptions& options) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    const TextSource text(source);
    return ObjReader(text.source(), options.crease_angle_deg.value_or(automatic_crease_deg)).read();
}

}  // namespace easypbr::io
