#include "easypbr/scene/cut.h"

#include <algorithm>
#include <array>
#include <limits>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/normals.h"

namespace easypbr {
namespace {

constexpr size_t cut_grain = 1 << 15;

/// A vertex of the result: one of the mesh's own, or a mixture of up to three.
struct Mixture {
    std::array<int32_t, 3> vertex{0, 0, 0};
    Vec3 weight{1, 0, 0};
};

std::vector<uint8_t> which_are_kept(const Array3f& V, const std::vector<Eigen::Vector4d>& planes) {
    std::vector<uint8_t> kept(size_t(V.rows()));
    parallel_for(kept.size(), cut_grain, [&](size_t i) {
        const Vec3d p = V.row(Eigen::Index(i)).transpose().cast<double>();
        kept[i] = std::ranges::all_of(
            planes, [&](const Eigen::Vector4d& plane) { return plane.head<3>().dot(p) + plane[3] >= 0; });
    });
    return kept;
}

template <class ArrayType>
ArrayType mixed(const ArrayType& array, const std::vector<Mixture>& vertices) {
    if (array.empty()) return {};
    typename ArrayType::Dense rows(Eigen::Index(vertices.size()), array.cols());
    parallel_for(vertices.size(), cut_grain, [&](size_t i) {
        const Mixture& m = vertices[i];
        rows.row(Eigen::Index(i)) = array.row(m.vertex[0]) * m.weight[0];
        for (int k = 1; k < 3; ++k)
            if (m.weight[k] != 0) rows.row(Eigen::Index(i)) += array.row(m.vertex[size_t(k)]) * m.weight[k];
    });
    return ArrayType(std::move(rows));
}

/// The attributes of vertices that are mixtures of the mesh's.
MeshData with_vertices(const MeshData& mesh, const std::vector<Mixture>& vertices) {
    MeshData out = without_arrays(mesh);
    out.V = mixed(mesh.V, vertices);
    out.N = mixed(mesh.N, vertices);
    out.C = mixed(mesh.C, vertices);
    out.UV = mixed(mesh.UV, vertices);
    out.uv_tangents = mixed(mesh.uv_tangents, vertices);
    out.T = mixed(mesh.T, vertices);
    out.B = mixed(mesh.B, vertices);
    out.voxel_size = mesh.voxel_size;
    return out;
}

/// For each vertex the one that it came from, or that it has most of.
Array1i sources_of(const std::vector<Mixture>& vertices) {
    Array1i::Dense from(Eigen::Index(vertices.size()));
    for (size_t i = 0; i < vertices.size(); ++i) {
        Eigen::Index most;
        vertices[i].weight.maxCoeff(&most);
        from[Eigen::Index(i)] = vertices[i].vertex[size_t(most)];
    }
    return Array1i(std::move(from));
}

/// The sources of vertices that are left whole; what is mixed comes from none, and has a number of its own.
Array1i continued_sources(const Array1i& source_vertex, const std::vector<Mixture>& vertices) {
    if (source_vertex.empty()) return {};
    // So that the last new number is one of 32 bits.
    const Array1i given =
        numbers_below(int64_t(std::numeric_limits<int32_t>::max()) - int64_t(vertices.size()), source_vertex);
    int32_t next = given.maxCoeff();
    Array1i::Dense source(Eigen::Index(vertices.size()));
    for (size_t i = 0; i < vertices.size(); ++i)
        source[Eigen::Index(i)] = vertices[i].weight[0] == 1 ? given(vertices[i].vertex[0]) : ++next;
    return Array1i(std::move(source));
}

MeshData cut_points(const MeshData& mesh, const std::vector<uint8_t>& kept, Array1i& source) {
    std::vector<Mixture> vertices;
    for (size_t i = 0; i < kept.size(); ++i)
        if (kept[i]) vertices.push_back({{int32_t(i), 0, 0}, Vec3(1, 0, 0)});
    source = sources_of(vertices);
    MeshData out = with_vertices(mesh, vertices);
    out.splats = rows_of(mesh.splats, {source.data(), size_t(source.size())});
    return out;
}

/// Cuts faces and edges; own vertices that are kept are shared again.
class Cutter {
  public:
    Cutter(const MeshData& mesh, const std::vector<Eigen::Vector4d>& planes, const std::vector<uint8_t>& kept)
        : mesh_(mesh), planes_(planes), kept_(kept), index_(kept.size(), -1) {}

    void face(const int32_t* f) {
        // Sutherland and Hodgman 1974, in weights of the corners.
        std::vector<Vec3> polygon{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
        if (!(kept_[size_t(f[0])] && kept_[size_t(f[1])] && kept_[size_t(f[2])]))
            polygon = clipped(std::move(polygon), f, 3, true);
        for (size_t k = 2; k < polygon.size(); ++k)
            for (const Vec3& weight : {polygon[0], polygon[k - 1], polygon[k]})
                faces_.push_back(vertex(f, weight));
    }

    void edge(const int32_t* e) {
        const int32_t ends[3] = {e[0], e[1], e[1]};
        std::vector<Vec3> polygon{Vec3(1, 0, 0), Vec3(0, 1, 0)};
        if (!(kept_[size_t(e[0])] && kept_[size_t(e[1])]))
            polygon = clipped(std::move(polygon), ends, 2, false);
        if (polygon.size() == 2)
            for (const Vec3& weight : polygon) edges_.push_back(vertex(ends, weight));
    }

    const std::vector<Mixture>& vertices() const { return vertices_; }
    const std::vector<int32_t>& faces() const { return faces_; }
    const std::vector<int32_t>& edges() const { return edges_; }

  private:
    std::vector<Vec3> clipped(std::vector<Vec3> polygon, const int32_t* f, int corners, bool closed) const {
        for (const Eigen::Vector4d& plane : planes_) {
            Vec3d distance = Vec3d::Zero();
            for (int k = 0; k < corners; ++k)
                distance[k] = plane.head<3>().dot(mesh_.V.row(f[k]).transpose().cast<double>()) + plane[3];
            std::vector<Vec3> rest;
            const size_t sides = closed ? polygon.size() : polygon.size() - 1;
            const auto height = [&](const Vec3& weight) { return weight.cast<double>().dot(distance); };
            if (!closed && height(polygon[0]) >= 0) rest.push_back(polygon[0]);
            for (size_t i = 0; i < sides; ++i) {
                const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
                const double ha = height(a), hb = height(b);
                if (closed && ha >= 0) rest.push_back(a);
                if ((ha >= 0) != (hb >= 0)) rest.push_back(a + float(ha / (ha - hb)) * (b - a));
                if (!closed && hb >= 0) rest.push_back(b);
            }
            polygon = std::move(rest);
            if (polygon.size() < 2) return {};
        }
        return polygon;
    }

    int32_t vertex(const int32_t* f, const Vec3& weight) {
        for (int k = 0; k < 3; ++k)
            if (weight[k] == 1) {
                int32_t& own = index_[size_t(f[k])];
                if (own < 0) {
                    own = int32_t(vertices_.size());
                    vertices_.push_back({{f[k], 0, 0}, Vec3(1, 0, 0)});
                }
                return own;
            }
        vertices_.push_back({{f[0], f[1], f[2]}, weight});
        return int32_t(vertices_.size()) - 1;
    }

    const MeshData& mesh_;
    const std::vector<Eigen::Vector4d>& planes_;
    const std::vector<uint8_t>& kept_;
    std::vector<int32_t> index_;
    std::vector<Mixture> vertices_;
    std::vector<int32_t> faces_, edges_;
};

template <class ArrayType>
ArrayType array_of_rows(const std::vector<int32_t>& values) {
    constexpr int cols = ArrayType::Dense::ColsAtCompileTime;
    return ArrayType(typename ArrayType::Dense(Eigen::Map<const typename ArrayType::Dense>(
        values.data(), Eigen::Index(values.size()) / cols, cols)));
}

MeshData cut_surface(const MeshData& given, const std::vector<Eigen::Vector4d>& planes,
                     const std::vector<uint8_t>& kept, Array1i& source, Array1i& vertices) {
    MeshData mesh = given;
    if (mesh.N.empty() && !mesh.F.empty()) mesh.N = smooth_normals(mesh);
    Cutter cutter(mesh, planes, kept);
    std::vector<int32_t> from;
    std::vector<MeshPart> parts = mesh.parts;
    const auto faces_so_far = [&] { return int(cutter.faces().size() / 3); };
    const auto cut_faces = [&](int first, int count) {
        for (int i = first; i < first + count; ++i) {
            cutter.face(mesh.F.data() + 3 * i);
            from.resize(size_t(faces_so_far()), int32_t(i));
        }
    };
    if (parts.empty()) cut_faces(0, int(mesh.F.rows()));
    for (MeshPart& part : parts) {
        const int first = faces_so_far();
        cut_faces(part.first_face, part.face_count);
        part.first_face = first;
        part.face_count = faces_so_far() - first;
    }
    for (Eigen::Index i = 0; i < mesh.E.rows(); ++i) cutter.edge(mesh.E.data() + 2 * i);
    MeshData out = with_vertices(mesh, cutter.vertices());
    out.F = array_of_rows<Array3i>(cutter.faces());
    out.E = array_of_rows<Array2i>(cutter.edges());
    out.parts = std::move(parts);
    source = array_of_rows<Array1i>(from);
    out.source_vertex = continued_sources(mesh.source_vertex, cutter.vertices());
    vertices = sources_of(cutter.vertices());
    // Pieces of a face are one polygon, so that a wireframe shows no edges between them.
    Array1i::Dense polygon = source;
    if (!mesh.source_face.empty())
        for (auto& face : polygon) face = mesh.source_face(face);
    out.source_face = Array1i(std::move(polygon));
    return out;
}

}  // namespace

MeshData cut(const MeshData& mesh, const std::vector<Eigen::Vector4d>& planes, bool by_vertex, Array1i& faces,
             Array1i& vertices) {
    const std::vector<uint8_t> kept = which_are_kept(mesh.V, planes);
    return by_vertex ? cut_points(mesh, kept, vertices) : cut_surface(mesh, planes, kept, faces, vertices);
}

}  // namespace easypbr
