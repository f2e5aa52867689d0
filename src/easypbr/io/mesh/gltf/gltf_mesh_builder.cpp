#include "easypbr/io/mesh/gltf/gltf_mesh_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh/gltf/gltf_accessor.h"
#include "easypbr/io/mesh/gltf/gltf_blocks.h"
#include "easypbr/io/mesh/gltf/gltf_draco.h"
#include "easypbr/io/mesh/gltf/gltf_used_rows.h"
#include "easypbr/io/mesh/gltf/gltf_values.h"
#include "easypbr/io/mesh/gltf/gltf_vertices.h"
#include "easypbr/scene/normals.h"

namespace easypbr::io {
namespace {

constexpr size_t vertex_grain = 1 << 15;

/// Triangle corners of a list of `count` indices, by the winding rules of the specification, section 3.7.2.1.
template <class Index>
std::vector<int32_t> triangle_corners(GltfMode mode, size_t count, Index&& index) {
    std::vector<int32_t> out;
    if (mode == GltfMode::triangles) {
        out.resize(count / 3 * 3);
        parallel_for(out.size(), vertex_grain, [&](size_t i) { out[i] = index(i); });
        return out;
    }
    for (size_t i = 0; i + 2 < count; ++i) {
        const bool strip = mode == GltfMode::triangle_strip;
        const int32_t a = strip ? index(i) : index(i + 1);
        const int32_t b = strip ? index(i + 1 + i % 2) : index(i + 2);
        const int32_t c = strip ? index(i + 2 - i % 2) : index(0);
        // Strips are stitched together by triangles without area.
        if (a != b && b != c && c != a) out.insert(out.end(), {a, b, c});
    }
    return out;
}

/// Makes a mesh of a group.
class MeshBuilder {
  public:
    MeshBuilder(GltfDocument& document, const GltfMaterials& materials,
                const std::set<size_t>& shared_positions, const GltfMeshSource& source,
                const GltfPrimitiveGroup& group)
        : document_(document),
          materials_(materials),
          shared_positions_(shared_positions),
          source_(source),
          group_(group),
          reader_(document, source.name, value_names()) {}

    GltfMesh build() {
        for (const GltfPrimitive& primitive : group_.primitives) add(primitive);
        read_blocks();
        for (Element& element : elements_) {
            add_elements(element);
            element.index = {};
        }
        // Lines and points without a material keep the default, which draws lines dark.
        if (const auto material = group_.primitives.front().material;
            group_.kind != GltfKind::faces && material)
            material_index(material);
        merge_vertices();
        out_.F = Array3i(Eigen::Map<const Array3i::Dense>(faces_.data(), Eigen::Index(faces_.size() / 3), 3));
        if (!edges_.empty())
            out_.E =
                Array2i(Eigen::Map<const Array2i::Dense>(edges_.data(), Eigen::Index(edges_.size() / 2), 2));
        GltfMesh mesh{std::move(out_), {}, {}, std::move(sources_), {}};
        read_deformation(mesh);
        return mesh;
    }

  private:
    /// What of a primitive is left when its block is known.
    struct Element {
        GltfMode mode;
        std::optional<size_t> material, indices;  ///< numbers in the file
        size_t block;
        std::vector<uint32_t> index;  ///< without rows where there are no indices
    };

    [[noreturn]] void fail(const std::string& what) const { document_.fail(source_.name + " " + what); }

    /// Names of application-specific attributes, of all primitives.
    std::set<std::string> value_names() const {
        std::set<std::string> names;
        for (const GltfPrimitive& primitive : group_.primitives)
            find_gltf_values(document_, primitive.json->at("attributes"), names);
        return names;
    }

    void add(const GltfPrimitive& primitive) {
        const Json& json = *primitive.json;
        const auto compressed = unpack_draco(document_, json, source_.name);
        const size_t block = block_of(block_accessors(document_, json, materials_.uv_set(primitive.material),
                                                      reader_.value_names(), compressed));
        Element element{
            primitive.mode, primitive.material, document_.optional_integer(json, "indices"), block, {}};
        if (element.indices) element.index = read_indices(document_, *element.indices);
        const size_t count = position_counts_[block];
        for (const uint32_t index : element.index)
            if (index >= count)
                fail(fmt::format("has index {} of {} vertices (accessors[{}])", index, count,
                                 *element.indices));
        elements_.push_back(std::move(element));
    }

    /// Compressed vertices are there only until the next primitive; others are read by read_blocks().
    size_t block_of(const GltfBlockAccessors& accessors) {
        const auto [found, is_new] = block_index_.try_emplace(accessors, blocks_.size());
        if (is_new) {
            block_accessors_.push_back(&found->first);
            blocks_.push_back(accessors.compressed ? reader_.read(accessors, nullptr) : VertexBlock());
            position_counts_.push_back(accessors.compressed
                                           ? size_t(blocks_.back().row_count)
                                           : gltf_rows(document_, *accessors.position).count);
        }
        return found->second;
    }

    /// Whether a mesh keeps the rows that it does not index, so that vertices keep the numbers that they have
    /// in the file. Points that none indexes are not drawn; lines beside others do without their vertices.
    bool keeps_all_rows(size_t block) const {
        const bool is_whole_mesh = source_.json.at("primitives").size() == group_.primitives.size();
        const bool is_kept =
            group_.kind == GltfKind::faces || (group_.kind == GltfKind::lines && is_whole_mesh);
        return is_kept && !shared_positions_.contains(*block_accessors_[block]->position);
    }

    void read_blocks() {
        std::vector<std::vector<const std::vector<uint32_t>*>> lists(blocks_.size());
        for (const Element& element : elements_) {
            const bool takes_all = !element.indices || keeps_all_rows(element.block);
            lists[element.block].push_back(takes_all ? nullptr : &element.index);
        }
        std::vector<GltfUsedRows> used;
        for (size_t b = 0; b < blocks_.size(); ++b) {
            const std::vector<int32_t>* rows = used.emplace_back(position_counts_[b], lists[b]).rows();
            VertexBlock& block = blocks_[b];
            if (!block_accessors_[b]->compressed)
                block = reader_.read(*block_accessors_[b], rows);
            else if (rows)
                choose_rows(block, *rows, source_.name);
            block.first = vertex_count_;
            vertex_count_ += block.row_count;
            if (vertex_count_ > std::numeric_limits<int32_t>::max()) fail("has more than 2^31 vertices");
        }
        for (Element& element : elements_) used[element.block].renumber(element.index);
    }

    void add_elements(const Element& element) {
        VertexBlock& block = blocks_[element.block];
        const size_t count = element.indices ? element.index.size() : size_t(block.row_count);
        const auto index = [&](size_t i) { return element.indices ? int32_t(element.index[i]) : int32_t(i); };
        if (element.mode >= GltfMode::triangles)
            add_part(triangle_corners(element.mode, count, index), element.material, block);
        else if (element.mode != GltfMode::points)
            add_lines(element.mode, count, index, int32_t(block.first));
    }

    void add_part(const std::vector<int32_t>& corners, std::optional<size_t> material, VertexBlock& block) {
        block.triangles.insert(block.triangles.end(), corners.begin(), corners.end());
        if ((faces_.size() + corners.size()) / 3 > size_t(std::numeric_limits<int32_t>::max()))
            fail("has more than 2^31 faces");
        MeshPart part;
        part.first_face = int(faces_.size() / 3);
        part.face_count = int(corners.size() / 3);
        part.material = material_index(material);
        part.name = out_.materials[size_t(part.material)].name;
        out_.parts.push_back(part);
        for (const int32_t corner : corners) faces_.push_back(corner + int32_t(block.first));
    }

    int material_index(std::optional<size_t> material) {
        const auto [found, is_new] = material_index_.try_emplace(material, int(out_.materials.size()));
        if (is_new) {
            out_.materials.push_back(materials_.material(material));
            sources_.push_back(material);
        }
        return found->second;
    }

    template <class Index>
    void add_lines(GltfMode mode, size_t count, Index&& index, int32_t first) {
        const size_t step = mode == GltfMode::lines ? 2 : 1;
        for (size_t i = 0; i + 1 < count; i += step)
            edges_.insert(edges_.end(), {first + index(i), first + index(i + 1)});
        if (mode == GltfMode::line_loop && count > 2)
            edges_.insert(edges_.end(), {first + index(count - 1), first + index(0)});
    }

    /// One column block of all vertices, of(block) of each; rows of blocks that lack it have `fallback`.
    template <class Of>
    ArrayXf::Dense merged_of(float fallback, Of&& of) {
        Eigen::Index columns = 0;
        for (VertexBlock& block : blocks_)
            if (of(block).rows()) columns = std::max(columns, of(block).cols());
        if (columns == 0) return ArrayXf::Dense(0, 0);
        if (blocks_.size() == 1) return std::move(of(blocks_[0]));
        ArrayXf::Dense out = ArrayXf::Dense::Constant(vertex_count_, columns, fallback);
        for (VertexBlock& block : blocks_) {
            const ArrayXf::Dense& from = of(block);
            if (from.rows()) out.block(block.first, 0, from.rows(), from.cols()) = from;
        }
        return out;
    }
    ArrayXf::Dense merged(ArrayXf::Dense VertexBlock::*attribute, float fallback) {
        return merged_of(fallback, [&](VertexBlock& block) -> ArrayXf::Dense& { return block.*attribute; });
    }

    void read_deformation(GltfMesh& mesh) {
        Deformation& out = mesh.deformation;
        out.joints = ArrayXf(merged(&VertexBlock::joints, 0));
        out.weights = ArrayXf(merged(&VertexBlock::weights, 0));
        const size_t targets = source_.target_count;
        for (size_t k = 0; k < targets; ++k) {
            const auto target = [&](std::vector<ArrayXf::Dense> VertexBlock::*list) {
                return merged_of(0, [&](VertexBlock& block) -> ArrayXf::Dense& {
                    return k < (block.*list).size() ? (block.*list)[k] : none_;
                });
            };
            const ArrayXf::Dense V = target(&VertexBlock::targets_V), N = target(&VertexBlock::targets_N);
            out.targets_V.push_back(V.rows() ? Array3f(V) : Array3f(Array3f::Dense::Zero(vertex_count_, 3)));
            out.targets_N.push_back(N.rows() ? Array3f(N) : Array3f());
        }
        if (const Json* weights = member(source_.json, "weights"); weights && weights->is_array()) {
            if (weights->size() != targets)
                fail(fmt::format("has {} morph targets and {} weights", targets, weights->size()));
            for (const Json& weight : *weights) mesh.weights.push_back(weight.get<float>());
        }
        mesh.weights.resize(targets, 0);
        if (out.empty()) return;
        out.V = mesh.data.V;
        out.N = mesh.data.N;
        out.uv_tangents = mesh.data.uv_tangents;
        out.flat_F = flat_F_;
    }

    /// Section 3.7.2.1 of the specification: without normals, flat ones.
    void compute_missing_normals() {
        const auto has_normals = [](const VertexBlock& block) { return block.N.rows() > 0; };
        if (std::ranges::none_of(blocks_, has_normals)) {
            out_.style.flat = true;
            return;
        }
        if (std::ranges::all_of(blocks_, has_normals)) return;
        const GltfFlatFaces flat = split_flat_faces(blocks_, faces_, edges_, source_.name);
        vertex_count_ = blocks_.back().first + blocks_.back().row_count;
        flat_F_ = flat.F;
        out_.source_vertex = flat.source_vertex;
        for (VertexBlock& block : blocks_) {
            if (has_normals(block)) continue;
            const Eigen::Map<const Array3i::Dense> F(block.triangles.data(),
                                                     Eigen::Index(block.triangles.size() / 3), 3);
            block.N = vertex_normals(Array3f(block.V), Array3i(F));
        }
    }

    void merge_vertices() {
        for (const VertexBlock& block : blocks_)
            if (!block.V.allFinite()) fail("has positions that are not finite");
        compute_missing_normals();
        if (ArrayXf::Dense V = merged(&VertexBlock::V, 0); V.rows()) out_.V = Array3f(V);
        if (ArrayXf::Dense N = merged(&VertexBlock::N, 0); N.rows()) out_.N = Array3f(N);
        if (ArrayXf::Dense UV = merged(&VertexBlock::UV, 0); UV.rows()) out_.UV = Array2f(UV);
        if (ArrayXf::Dense T = merged(&VertexBlock::tangents, 0); T.rows()) out_.uv_tangents = Array4f(T);
        if (ArrayXf::Dense C = merged(&VertexBlock::C, 1); C.rows()) {
            out_.C = ArrayXf(std::move(C));
            // They are what these factors multiply, a factor of 0.6 as well.
            for (Material& material : out_.materials) material.base_color_given = true;
        }
        for (const std::string& name : reader_.value_names()) {
            const float missing = name == gltf_label_name       ? -1.0f
                                  : name == gltf_intensity_name ? 0.0f
                                                                : std::numeric_limits<float>::quiet_NaN();
            const ArrayXf::Dense values = merged_of(
                missing, [&](VertexBlock& block) -> ArrayXf::Dense& { return block.values.at(name); });
            if (values.rows()) add_gltf_values(name, values, reader_.rounding(name), document_.path(), out_);
        }
    }

    GltfDocument& document_;
    const GltfMaterials& materials_;
    const std::set<size_t>& shared_positions_;
    const GltfMeshSource& source_;
    const GltfPrimitiveGroup& group_;
    GltfBlockReader reader_;
    MeshData out_;
    std::vector<Element> elements_;
    std::map<GltfBlockAccessors, size_t> block_index_;
    // One of each for each block.
    std::vector<VertexBlock> blocks_;
    std::vector<const GltfBlockAccessors*> block_accessors_;  ///< keys of block_index_
    std::vector<size_t> position_counts_;
    ArrayXf::Dense none_;  ///< what a block has of a morph target that it lacks
    std::map<std::optional<size_t>, int> material_index_;
    std::vector<std::optional<size_t>> sources_;  ///< of out_.materials
    Eigen::Index vertex_count_ = 0;
    std::vector<int32_t> faces_, edges_;
    Array3i flat_F_;  ///< with vertices of their own, as they have no normals in the file
};

}  // namespace

GltfMesh build_gltf_mesh(GltfDocument& document, const GltfMaterials& materials,
                         const std::set<size_t>& shared_positions, const GltfMeshSource& source,
                         const GltfPrimitiveGroup& group) {
    return MeshBuilder(document, materials, shared_positions, source, group).build();
}

}  // namespace easypbr::io
