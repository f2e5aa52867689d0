#include "easypbr/io/mesh/gltf/gltf_blocks.h"

#include <fmt/format.h>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/mesh/gltf/gltf_accessor.h"
#include "easypbr/io/mesh/gltf/gltf_values.h"

namespace easypbr::io {
namespace {

constexpr int most_attribute_columns = 4;  ///< of application-specific attributes

void append_columns(ArrayXf::Dense& to, const ArrayXf::Dense& more) {
    const Eigen::Index before = to.cols();
    to.conservativeResize(more.rows(), before + more.cols());
    to.rightCols(more.cols()) = more;
}

}  // namespace

GltfBlockAccessors block_accessors(const GltfDocument& document, const Json& primitive, int uv_set,
                                   const std::set<std::string>& value_names,
                                   std::optional<size_t> compressed) {
    const Json& attributes = primitive.at("attributes");
    const auto of = [&](const std::string& name) {
        return document.optional_integer(attributes, name.c_str());
    };
    GltfBlockAccessors out;
    out.position = of("POSITION"), out.normal = of("NORMAL");
    out.color = of("COLOR_0"), out.tangent = of("TANGENT");
    out.uv = of(fmt::format("TEXCOORD_{}", uv_set));
    if (!out.uv) out.uv = of("TEXCOORD_0");
    for (int set = 0;; ++set) {
        const auto joints = of(fmt::format("JOINTS_{}", set)), weights = of(fmt::format("WEIGHTS_{}", set));
        if (!joints || !weights) break;
        out.influences.push_back({joints, weights});
    }
    for (const std::string& name : value_names) out.values.push_back(of(name));
    if (const Json* targets = member(primitive, "targets"); targets && targets->is_array())
        for (const Json& target : *targets)
            out.targets.push_back(
                {document.optional_integer(target, "POSITION"), document.optional_integer(target, "NORMAL")});
    out.compressed = compressed;
    return out;
}

/// The rows of a block, which all its accessors must have.
struct GltfBlockReader::Vertices {
    GltfBlockReader& reader;
    const std::vector<int32_t>* rows;
    size_t count = 0;  ///< of the positions, with those that are left out

    void require_count(size_t accessor, size_t there) const {
        if (there != count)
            reader.document_.fail(fmt::format("{} has {} positions, but accessors[{}] has {} rows",
                                              reader.name_, count, accessor, there));
    }

    void read(std::optional<size_t> accessor, int least, int most, ArrayXf::Dense& to) const {
        if (!accessor) return;
        if (rows) require_count(*accessor, gltf_rows(reader.document_, *accessor).count);
        to = read_floats(reader.document_, *accessor, least, most, rows);
        if (!rows) require_count(*accessor, size_t(to.rows()));
    }
};

VertexBlock GltfBlockReader::read(const GltfBlockAccessors& accessors, const std::vector<int32_t>* rows) {
    VertexBlock block;
    block.V = read_floats(document_, *accessors.position, 3, 3, rows);
    const Vertices vertices{*this, rows,
                            rows ? gltf_rows(document_, *accessors.position).count : size_t(block.V.rows())};
    vertices.read(accessors.normal, 3, 3, block.N);
    vertices.read(accessors.uv, 2, 2, block.UV);
    vertices.read(accessors.color, 3, 4, block.C);
    // Section 3.7.2.1 of the specification: without normals tangents are ignored.
    if (accessors.normal) vertices.read(accessors.tangent, 4, 4, block.tangents);
    for (const auto& influence : accessors.influences) {
        ArrayXf::Dense joints, weights;
        vertices.read(influence[0], 4, 4, joints);
        vertices.read(influence[1], 4, 4, weights);
        append_columns(block.joints, joints);
        append_columns(block.weights, weights);
    }
    read_values(accessors, vertices, block.values);
    for (const auto& target : accessors.targets) {
        vertices.read(target[0], 3, 3, block.targets_V.emplace_back());
        vertices.read(target[1], 3, 3, block.targets_N.emplace_back());
    }
    tidy(block);
    block.row_count = block.V.rows();
    return block;
}

void GltfBlockReader::read_values(const GltfBlockAccessors& accessors, const Vertices& vertices,
                                  GltfValues& values) {
    size_t next = 0;
    for (const std::string& name : value_names_) {
        ArrayXf::Dense& read = values[name];
        const std::optional<size_t> accessor = accessors.values[next++];
        if (!accessor) continue;
        try {
            vertices.read(accessor, 1, most_attribute_columns, read);
            const auto counts = gltf_rounding(document_, *accessor, vertices.rows);
            std::vector<RoundingCounts>& all = rounding_[name];
            if (all.size() < counts.size()) all.resize(counts.size());
            for (size_t i = 0; i < counts.size(); ++i) all[i].add(counts[i]);
        } catch (const FormatError& error) {
            // The mesh is whole without it.
            read = {};
            log_warning(fmt::format("attribute {} is left out: {}", name, error.what()));
        }
    }
}

}  // namespace easypbr::io
