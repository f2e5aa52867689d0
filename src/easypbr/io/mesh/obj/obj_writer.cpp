#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/png_texels.h"
#include "easypbr/io/mesh/texture_mapping.h"
#include "easypbr/io/tables/face_polygons.h"
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

/// A name without what separates names, begins comments or continues lines.
std::string plain_word(std::string name) {
    for (char& c : name)
        if (ascii::is_space(c) || c == '#' || c == '\\') c = '_';
    return name;
}

/// A file's name as it stands in a line. Throws ArgumentError for one that no line can hold.
std::string name_in_line(const std::string& name) {
    if (name.find('\n') != name.npos)
        throw ArgumentError(fmt::format("OBJ: expected names of files without line breaks, got '{}'", name));
    // A relative path begins with no blank and no '-'.
    return name.starts_with('-') || name.starts_with(' ') || name.starts_with('\t') ? "./" + name : name;
}

/// The words of a text file, nothing where there is none.
std::set<std::string> words_in_file(const fs::path& path) {
    std::set<std::string> words;
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return words;
    std::ifstream file(path);
    for (std::string word; file >> word;) words.insert(word);
    return words;
}

class MtlWriter {
  public:
    /// `name`: of the MTL; images that no file holds are named after it. Files that are there stay, but for
    /// the images of an MTL of that name.
    MtlWriter(const fs::path& folder, const std::string& name)
        : folder_(folder),
          stem_(plain_word(fs::path(name).stem().string())),
          own_(words_in_file(folder / name)) {
        // Options begin with '-'.
        if (stem_.starts_with('-')) stem_[0] = '_';
    }

    /// A name that a texture's file has, changed or not, is no one else's.
    void keep_names_of(const Material& m) {
        for (const Texture* texture : {&m.base_color_texture, &m.emissive_texture, &m.roughness_texture,
                                       &m.metallic_texture, &m.opacity_texture, &m.normal_texture})
            if (std::error_code ignored; !texture->image || fs::exists(texture->path, ignored))
                taken_.insert(path_of(*texture));
    }

    /// The name of the material in the MTL, one line, never empty. Materials that are the same there share
    /// it. `color`: see Material::color_factor().
    std::string add(const Material& m, const Vec3& color) {
        body_.clear();
        append(m, color);
        const std::string plain = m.name.empty() ? "material" : plain_word(m.name);
        std::string& name = materials_[{plain, body_}];
        for (int i = 1; name.empty(); ++i) {
            std::string free = i == 1 ? plain : fmt::format("{}_{}", plain, i);
            if (!material_names_.insert(free).second) continue;
            name = std::move(free);
            text_ += fmt::format("newmtl {}\n{}", name, body_);
        }
        return name;
    }

    std::string take() { return std::move(text_); }
    std::map<std::string, std::shared_ptr<const Image>> take_images() { return std::move(images_); }

  private:
    void append(const Material& m, const Vec3& color) {
        line("Kd {} {} {}\n", color.x(), color.y(), color.z());
        line("Ke {} {} {}\n", m.emissive.x(), m.emissive.y(), m.emissive.z());
        line("Pr {}\nPm {}\nd {}\nillum {}\n", m.roughness, m.metallic, m.opacity, m.unlit ? 0 : 2);
        map("map_Kd", "base_color", TexelUse::color, m.base_color_texture);
        map("map_Ke", "emissive", TexelUse::color, m.emissive_texture);
        map("map_Pr", "roughness", TexelUse::number, m.roughness_texture);
        map("map_Pm", "metallic", TexelUse::number, m.metallic_texture);
        map("map_d", opacity_kind, TexelUse::number, obj_opacity_texture(m));
        map("norm", "normal", TexelUse::vector, m.normal_texture,
            m.normal_scale == 1 ? "" : fmt::format(" -bm {}", m.normal_scale));
    }

    template <class... Values>
    void line(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(body_), format, std::forward<Values>(values)...);
    }

    static constexpr std::string_view opacity_kind = "opacity";

    void map(const char* keyword, std::string_view kind, TexelUse use, const Texture& texture,
             const std::string& option = {}) {
        if (texture.path.empty() && !texture.image) return;
        body_ += keyword + option;
        // Readers take the alpha of an image for the opacity.
        const bool with_alpha = texture.image && has_alpha(*texture.image);
        const bool is_alpha = with_alpha && texture.channel == texture.image->channels() - 1;
        if (texture.channel > 0 || (with_alpha && kind == opacity_kind))
            line(" -imfchan {}", is_alpha ? 'm' : "rgbm"[texture.channel]);
        if (texture.wrap_u == Wrap::clamp && texture.wrap_v == Wrap::clamp) body_ += " -clamp on";
        const Mat3& M = texture.uv_transform;
        if (!M.isIdentity(0) && obj_mapping().has_transform(M))
            line(" -s {} {} -o {} {}", M(0, 0), M(1, 1), M(0, 2), M(1, 2));
        line(" {}\n", is_in_file(texture) ? name_in_line(path_of(texture))
                                          : name_of(texels_.of(texture, use, kind), kind));
    }

    std::string path_of(const Texture& texture) const {
        return texture.path.empty() ? std::string() : path_from_folder(texture.path, folder_);
    }

    /// The name of an image made in memory or embedded in a GLB: the same for all uses of its texels.
    const std::string& name_of(const std::shared_ptr<const Image>& image, std::string_view kind) {
        std::string& name = names_[image];
        for (int i = 1; name.empty(); ++i) {
            std::string free = fmt::format("{}_{}{}.png", stem_, kind, i == 1 ? "" : fmt::format("_{}", i));
            if (is_free(free) && taken_.insert(free).second) name = std::move(free);
        }
        images_[name] = image;
        return name;
    }

    bool is_free(const std::string& name) const {
        std::error_code ignored;
        return own_.contains(name) || !fs::exists(folder_ / name, ignored);
    }

    fs::path folder_;
    std::string stem_, text_, body_;
    std::set<std::string> own_, taken_, material_names_;
    PngTexels texels_;
    std::map<std::pair<std::string, std::string>, std::string> materials_;  ///< by plain name and body
    std::map<std::shared_ptr<const Image>, std::string> names_;
    std::map<std::string, std::shared_ptr<const Image>> images_;
};

}  // namespace

ObjText encode_obj(const MeshData& mesh, const std::string& mtl_name, const fs::path& folder) {
    ObjText text;
    std::vector<std::string> names;
    MtlWriter writer(folder, mtl_name);
    for (const Material& material : mesh.materials) writer.keep_names_of(material);
    const bool with_coordinates = !mesh.F.empty() && !mesh.UV.empty();
    for (const Material& material : mesh.materials)
        names.push_back(writer.add(material, material.color_factor(!mesh.C.empty(), with_coordinates)));
    text.mtl = writer.take();
    text.images = writer.take_images();
    if (!names.empty()) text.obj = fmt::format("mtllib {}\n", name_in_line(mtl_name));
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
