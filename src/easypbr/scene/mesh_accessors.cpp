// The accessors of Mesh: all read a snapshot or edit the data.
#include <utility>

#include "easypbr/scene/mesh.h"

namespace easypbr {

Mesh::Mesh(const char* path) : Mesh(std::filesystem::path(path)) {}

Array3f Mesh::V() const {
    return snapshot()->V;
}

Array3f Mesh::N() const {
    return snapshot()->N;
}

ArrayXf Mesh::C() const {
    return snapshot()->C;
}

Array2f Mesh::UV() const {
    return snapshot()->UV;
}

Array3f Mesh::T() const {
    return snapshot()->T;
}

Array1f Mesh::B() const {
    return snapshot()->B;
}

Array3i Mesh::F() const {
    return snapshot()->F;
}

Array2i Mesh::E() const {
    return snapshot()->E;
}

Array1i Mesh::L() const {
    return snapshot()->L;
}

Array1f Mesh::I() const {
    return snapshot()->I;
}

Vec3d Mesh::offset() const {
    return snapshot()->offset;
}

std::shared_ptr<const LabelMap> Mesh::label_map() const {
    return snapshot()->label_map;
}

Array1f Mesh::scalar(const std::string& name) const {
    return scalar_named(*snapshot(), name).values;
}

std::string Mesh::name() const {
    return snapshot()->name;
}

Style Mesh::style() const {
    return snapshot()->style;
}

Eigen::Affine3d Mesh::T_parent_mesh() const {
    return snapshot()->T_parent_mesh;
}

std::vector<Mesh> Mesh::children() const {
    return snapshot()->children;
}

void Mesh::set_V(Array3f V) {
    edit([&](MeshData& d) { d.V = V; });
}

void Mesh::set_offset(const Vec3d& offset) {
    edit([&](MeshData& d) { d.offset = offset; });
}

void Mesh::set_N(Array3f N) {
    edit([&](MeshData& d) { d.N = N; });
}

void Mesh::set_C(ArrayXf C) {
    edit([&](MeshData& d) { d.C = C; });
}

void Mesh::set_UV(Array2f UV) {
    edit([&](MeshData& d) { d.UV = UV; });
}

void Mesh::set_F(Array3i F) {
    edit([&](MeshData& d) {
        d.F = F;
        d.parts.clear();
        d.source_face = {};
    });
}

void Mesh::set_L(Array1i L) {
    edit([&](MeshData& d) { d.L = L; });
}

void Mesh::set_labels(Array1i L, std::shared_ptr<const LabelMap> label_map) {
    edit([&](MeshData& d) {
        d.L = L;
        d.label_map = label_map;
    });
}

void Mesh::set_label_map(std::shared_ptr<const LabelMap> label_map) {
    edit([&](MeshData& d) { d.label_map = label_map; });
}

void Mesh::set_style(const Style& style) {
    edit([&](MeshData& d) { d.style = style; });
}

void Mesh::set_T_parent_mesh(const Eigen::Affine3d& T) {
    edit([&](MeshData& d) { d.T_parent_mesh = T; });
}

void Mesh::set_label_map(LabelMap label_map) {
    set_label_map(std::make_shared<const LabelMap>(std::move(label_map)));
}

void Mesh::scale(double factor) {
    scale(Vec3d(factor, factor, factor));
}
}  // namespace easypbr
