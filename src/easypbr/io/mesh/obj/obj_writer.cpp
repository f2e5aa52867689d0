#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <set>

#include "easypbr/core/parallel.h"
#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/tables/face_polygons.h"
#include "easypbr/io/mesh/texture_mapping.h"
#include "easypbr/scene/normals.h"

namespace easypbr::io {
namespace {

constexpr size_t line_grain = 1 << 14;

/// Lines made in parallel: write(row, out) appends those of one row.
template <class Write>
void append_lines(size_t count, std::string& out, Write&& write) {
    std::vector<std::string> parts((count + line_grain - 1) / line_grain);
    parallel_chunks(count, line_grain, [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end; ++row) write(Eigen::Index(row), parts[begin / line_grain]);
    });
    for (const std::string& part : parts) out += part;
}

/// Numbers are written with the fewest digits that read back as the same float.
template <class Row>
void append_numbers(const Row& row, std::string& line) {
    for (Eigen::Index k = 0; k < row.size(); ++k)
        fmt::format_to(std::back_inserter(line), " {}", float(row(k)));
}

/// The same for double precision.
void append_position(const Eigen::RowVector3d& position, std::string& line) {
    for (const double value : position) fmt::format_to(std::back_inserter(line), " {}", value);
}

/// What is drawn flat has a normal for each face.
bool is_flat(const MeshData& mesh) {
    return mesh.N.empty() && !mesh.F.empty() && mesh.style.flat.value_or(false);
}

void append_vertices(const MeshData& mesh, std::string& out) {
    append_lines(size_t(mesh.V.rows()), out, [&](Eigen::Index row, std::string& text) {
        text += "v";
        if (mesh.offset.isZero(0))
            append_numbers(mesh.V.row(row), text);
        else
            append_position(mesh.V.row(row).cast<double>() + mesh.offset.transpose(), text);
        if (!mesh.C.empty()) append_numbers(mesh.C.row(row).template head<3>(), text);
        text += '\n';
    });
    append_lines(size_t(mesh.UV.rows()), out, [&](Eigen::Index row, std::string& text) {
        text += "vt";
        append_numbers(mesh.UV.row(row), text);
        text += '\n';
    });
    const Array3f N = is_flat(mesh) ? face_normals(mesh.V, mesh.F) : mesh.N;
    append_lines(size_t(N.rows()), out, [&](Eigen::Index row, std::string& text) {
        text += "vn";
        append_numbers(N.row(row), text);
        text += '\n';
    });
}

void append_faces(const MeshData& mesh, const FacePolygons& polygons, const MeshPart& part,
                  std::string& out) {
    const bool has_uv = !mesh.UV.empty(), flat = is_flat(mesh), has_normal = flat || !mesh.N.empty();
    const size_t first = polygons.polygons_before(part.first_face),
                 end = polygons.polygons_before(part.first_face + part.face_count);
    append_lines(end - first, out, [&](Eigen::Index row, std::string& text) {
        const size_t polygon = first + size_t(row);
        text += "f";
        for (const int32_t corner : polygons.corners(polygon)) {
            const int32_t v = corner + 1, n = flat ? int32_t(polygons.face(polygon)) + 1 : v;
            const auto to = std::back_inserter(text);
            if (has_uv && has_normal) fmt::format_to(to, " {0}/{0}/{1}", v, n);
            if (has_uv && !has_normal) fmt::format_to(to, " {0}/{0}", v);
            if (!has_uv && has_normal) fmt::format_to(to, " {}//{}", v, n);
            if (!has_uv && !has_normal) fmt::format_to(to, " {0}", v);
        }
        text += '\n';
    });
}

/// Names as OBJ and MTL can hold them: one line, never empty, never the same twice.
std::vector<std::string> material_names(const MeshData& mesh) {
    std::vector<std::string> names;
    for (const Material& material : mesh.materials) {
        std::string name = material.name;
        for (char& c : name)
            if (std::isspace(static_cast<unsigned char>(c)) || c == '#' || c == '\\') c = '_';
        if (name.empty() || std::find(names.begin(), names.end(), name) != names.end())
            name += fmt::format("material_{}", names.size());
        names.push_back(name);
    }
    return names;
}

class MtlWriter {
  public:
    /// `stem`: of the names of images that no file holds.
    MtlWriter(const fs::path& folder, const std::string& stem) : folder_(folder), stem_(stem) {
        for (char& c : stem_)
            if (std::isspace(static_cast<unsigned char>(c)) || c == '#') c = '_';
    }

    /// A name that a texture's file has is no one else's.
    void keep_names_of(const Material& m) {
        for (const Texture* texture : {&m.base_color_texture, &m.emissive_texture, &m.roughness_texture,
                                       &m.metallic_texture, &m.opacity_texture, &m.normal_texture})
            taken_.insert(path_of(*texture));
    }

    void append(const Material& m, const std::string& name) {
        line("newmtl {}\n", name);
        line("Kd {} {} {}\n", m.base_color.x(), m.base_color.y(), m.base_color.z());
        line("Ke {} {} {}\n", m.emissive.x(), m.emissive.y(), m.emissive.z());
        line("Pr {}\nPm {}\nd {}\nillum {}\n", m.roughness, m.metallic, m.opacity, m.unlit ? 0 : 2);
        map("map_Kd", "base_color", m.base_color_texture);
        map("map_Ke", "emissive", m.emissive_texture);
        map("map_Pr", "roughness", m.roughness_texture);
        map("map_Pm", "metallic", m.metallic_texture);
        map("map_d", "opacity", m.opacity_texture);
        map("norm", "normal", m.normal_texture,
            m.normal_scale == 1 ? "" : fmt::format(" -bm {}", m.normal_scale));
    }

    std::string take() { return std::move(text_); }
    std::map<std::string, std::shared_ptr<const Image>> take_images() { return std::move(images_); }

  private:
    template <class... Values>
    void line(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    }

    void map(const char* keyword, const char* kind, const Texture& texture, const std::string& option = {}) {
        if (texture.path.empty() && !texture.image) return;
        text_ += keyword + option;
        if (texture.channel > 0) line(" -imfchan {}", "rgbm"[texture.channel]);
        if (texture.wrap_u == Wrap::clamp && texture.wrap_v == Wrap::clamp) text_ += " -clamp on";
        const Mat3& M = texture.uv_transform;
        if (!M.isIdentity(0) && obj_mapping().has_transform(M))
            line(" -s {} {} -o {} {}", M(0, 0), M(1, 1), M(0, 2), M(1, 2));
        line(" {}\n", texture.path.empty() ? name_of(texture.image, kind) : path_of(texture));
    }

    std::string path_of(const Texture& texture) const {
        return texture.path.empty() ? std::string() : path_from_folder(texture.path, folder_);
    }

    /// The name of an image made in memory or embedded in a GLB: the same for all uses.
    const std::string& name_of(const std::shared_ptr<const Image>& image, const char* kind) {
        std::string& name = names_[image];
        for (int i = 1; name.empty(); ++i) {
            std::string free = fmt::format("{}_{}{}.png", stem_, kind, i == 1 ? "" : fmt::format("_{}", i));
            if (taken_.insert(free).second) name = std::move(free);
        }
        images_[name] = image;
        return name;
    }

    fs::path folder_;
    std::string stem_, text_;
    std::set<std::string> taken_;
    std::map<std::shared_ptr<const Image>, std::string> names_;
    std::map<std::string, std::shared_ptr<const Image>> images_;
};

}  // namespace

ObjText encode_obj(const MeshData& mesh, const std::string& mtl_name, const fs::path& folder) {
    ObjText text;
    const std::vector<std::string> names = material_names(mesh);
    MtlWriter writer(folder, fs::path(mtl_name).stem().string());
    for (const Material& material : mesh.materials) writer.keep_names_of(material);
    for (size_t i = 0; i < names.size(); ++i) writer.append(mesh.materials[i], names[i]);
    text.mtl = writer.take();
    text.images = writer.take_images();
    if (!names.empty()) text.obj = fmt::format("mtllib {}\n", mtl_name);
    append_vertices(mesh, text.obj);
    std::vector<MeshPart> parts = mesh.parts;
    if (parts.empty()) parts.push_back({{}, 0, int(mesh.F.rows()), 0});
    const FacePolygons polygons = is_flat(mesh) ? FacePolygons(mesh.F) : FacePolygons(mesh);
    for (const MeshPart& part : parts) {
        if (!names.empty()) text.obj += fmt::format("usemtl {}\n", names[size_t(part.material)]);
        append_faces(mesh, polygons, part, text.obj);
    }
    append_lines(size_t(mesh.E.rows()), text.obj, [&](Eigen::Index row, std::string& out) {
        fmt::format_to(std::back_inserter(out), "l {} {}\n", mesh.E(row, 0) + 1, mesh.E(row, 1) + 1);
    });
    return text;
}

}  // namespace easypbr::io
