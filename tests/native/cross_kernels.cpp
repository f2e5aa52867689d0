// Runs all kernels of one instruction set, which EASYPBR_ISA names, and prints a hash of what each writes
// with each of several sets of features. scripts/check_aarch64.sh compares what two processors print.
#include "cross_inputs.h"
#include "cross_places.h"
#include "easypbr/native/flush_subnormals.h"

namespace easypbr::native {

// clang-format off
#include "native/shader_uniforms.h"
// clang-format on

namespace EASYPBR_ISA {
extern const Kernels kernels;
}

namespace {

const Kernels& kernels = EASYPBR_ISA::kernels;

/// The uniforms of a run.
template <class Uniforms>
Uniforms uniforms_of(Case& run) {
    Uniforms u;
    Chooser chooser{run};
    u.visit(chooser);
    bool orthographic = false;
    // What shaders read is always there: coordinates where there are textures, tangents for normal textures.
    if constexpr (requires { u.is_orthographic; }) orthographic = u.is_orthographic;
    if constexpr (requires { u.has_uv; }) u.has_uv = u.has_uv || chooser.reads_textures;
    if constexpr (requires { u.is_flat; }) {
        u.sees_by_faces = u.sees_by_faces || u.is_flat;
        u.has_tangents = u.has_tangents || u.has_normal_texture;
        u.has_extensions = requires {
            u.u_coat;
        };
    }
    u.visit(Filler(run, orthographic));
    return u;
}

/// Pixels that a shader writes: blended otherwise, and others of them, in each set. In every other set they
/// are floats, which show the last bit, else of all formats in turn.
Region region_of(Case& run) {
    constexpr Pixels formats[] = {Pixels::rgba16f, Pixels::rgba8, Pixels::rgba16, Pixels::rg8,    Pixels::r16,
                                  Pixels::r16f,    Pixels::r32f,  Pixels::rg16,   Pixels::rgba32f};
    constexpr size_t sizes[] = {8, 4, 8, 2, 2, 2, 4, 4, 16};
    Region region;
    region.width = width;
    region.x0 = 3;
    region.x1 = width - 1;
    region.store = Store(run.set % 7);
    region.kept = 0.75f;
    region.where = Where(run.set / 2 % 3);
    for (int i = 0; i < most_outputs; ++i) {
        const int format = run.set % 2 == 0 || region.store == Store::under ? 8 : (run.set / 2 + i) % 9;
        const Pixels pixels = formats[format];
        const bool floats = pixels == Pixels::rgba32f || pixels == Pixels::r32f;
        const bool halves = pixels == Pixels::rgba16f || pixels == Pixels::r16f;
        const size_t bytes = sizes[format] * width * height;
        if (floats)
            region.outputs[i].data =
                reinterpret_cast<std::byte*>(run.output<uint32_t>(bytes / 4, Kind::floats));
        else
            region.outputs[i].data = reinterpret_cast<std::byte*>(
                run.output<uint16_t>(bytes / 2, halves ? Kind::halves : Kind::bits));
        region.outputs[i].pixels = pixels;
    }
    region.depth_channels = run.set % 2 == 0 ? 1 : 4;
    const float* depths =
        run.filled<float>(size_t{4} * width * height, [&] { return float(run.random.below(3)) * 0.25f; });
    static_cast<View&>(region.depth) = {
        reinterpret_cast<const std::byte*>(depths), width, height, 0, 0, width, height};
    return region;
}

template <class Uniforms>
void check_shader(std::string_view name, ShadeRows kernel) {
    all_sets(name, [&](Case& run) {
        const Uniforms uniforms = uniforms_of<Uniforms>(run);
        kernel(&uniforms, region_of(run), 1, height);
    });
}

/// Arrays of a stream: numbers between 0 and 1 at first, then what means something else.
class Arrays {
  public:
    static constexpr size_t count = 48;  // of which 37 are asked for

    explicit Arrays(Case& run) : run_(run) {}

    template <class Stream>
    void fill(Stream& s) {
        // What is written stands after what is read.
        const void* outputs;
        if constexpr (requires { s.o_color; })
            outputs = s.o_color;
        else
            outputs = s.o_light;
        auto* const first = reinterpret_cast<std::byte*>(&s);
        for (std::byte* member = first; member < first + sizeof s; member += sizeof(float*)) {
            const float* numbers =
                member < outputs ? run_.floats(count) : run_.output<float>(count, Kind::floats);
            std::memcpy(member, &numbers, sizeof numbers);
        }
        if constexpr (requires { s.v_normal; }) {
            directions(s.v_normal, nullptr, 1);
            directions(s.v_face, s.v_normal, 0.3f);
            directions(s.v_view, s.v_face, 0.8f);
        }
        if constexpr (requires { s.v_light_direction; }) directions(s.v_light_direction, s.v_face, 1.5f);
        if constexpr (requires { s.v_coat; }) {
            directions(s.v_coat, s.v_normal, 0.2f);
            directions(s.v_tangent, nullptr, 1);
            numbers(s.v_film[1], 1, 2);
            numbers(s.v_film[2], 0, 900);
            numbers(s.v_volume[1], 1, 2);
            numbers(s.v_volume[2], -0.5f, 1);
        }
    }

  private:
    void numbers(const float*& to, float low, float high) { to = run_.floats(count, low, high); }
    /// Unit vectors, around others where there are such.
    template <size_t n>
    void directions(const float* (&to)[n], const float* const* around, float spread) {
        float* parts[3] = {run_.array<float>(count), run_.array<float>(count), run_.array<float>(count)};
        for (size_t i = 0; i < count; ++i) {
            const uni::vec3 middle =
                around ? uni::vec3(around[0][i], around[1][i], around[2][i]) : uni::vec3();
            const uni::vec3 v = run_.direction(middle, spread);
            parts[0][i] = v.x;
            parts[1][i] = v.y;
            parts[2][i] = v.z;
        }
        std::memcpy(to, parts, sizeof parts);
    }

    Case& run_;
};

template <class Uniforms, class Stream>
void check_stream(std::string_view name, ShadeStream kernel) {
    all_sets(name, [&](Case& run) {
        const Uniforms uniforms = uniforms_of<Uniforms>(run);
        Stream stream;
        Arrays(run).fill(stream);
        kernel(&uniforms, &stream, 37);
    });
}

/// A bent grid of triangles before a camera.
struct Grid {
    static constexpr int columns = 7, rows = 6, pixels = 101;

    VisibleTriangles triangles;
    VisiblePixel places[pixels];

    explicit Grid(Case& run) {
        set_vertices(run);
        set_camera(run);
        set_targets(run);
        for (VisiblePixel& place : places) place = pixel_of(run);
    }

  private:
    void set_vertices(Case& run) {
        constexpr size_t vertices = size_t{columns} * rows;
        std::vector<float> V, N;
        std::vector<int32_t> F;
        for (int i = 0; i < columns * rows; ++i) {
            const int column = i % columns, row = i / columns;
            const float at[3] = {float(column) - 3, float(row) - 2.5f, 0};
            for (const float value : at) V.push_back(value + run.random.between(-0.3f, 0.3f));
            const uni::vec3 n = run.direction({0, 0, 1.5f});
            N.insert(N.end(), {n.x, n.y, n.z});
            if (column == columns - 1 || row == rows - 1) continue;
            F.insert(F.end(), {i, i + 1, i + columns, i + columns, i + 1, i + columns + 1});
        }
        VisibleTriangles& t = triangles;
        t.V = kept(run, V);
        t.N = kept(run, N);
        t.F = kept(run, F);
        faces_ = int(F.size() / 3);
        t.attributes.uvs = run.floats(2 * vertices, -1, 2);
        t.attributes.colors = run.floats(4 * vertices);
        t.attributes.tangents =
            run.filled<int16_t>(4 * F.size(), [&] { return run.random.below(65535) - 32767; });
    }
    template <class T>
    static const T* kept(Case& run, const std::vector<T>& values) {
        size_t i = 0;
        return run.filled<T>(values.size(), [&] { return values[i++]; });
    }
    void set_camera(Case& run) {
        VisibleTriangles& t = triangles;
        const double clip[4][4] = {
            {1.9, 0, 0, 0}, {0, 2.4, 0, 0}, {0, 0, 0, double(near_plane)}, {0, 0, -1, 8}};
        std::memcpy(t.clip_from_mesh, clip, sizeof clip);
        for (int i = 0; i < 9; ++i) {
            t.normal_from_mesh[i / 3][i % 3] = run.random.unit() * 0.2f + (i % 4 == 0 ? 1.0f : 0.0f);
            t.attributes.tangent_from_mesh[i / 3][i % 3] =
                run.random.unit() * 0.2f + (i % 4 == 0 ? 1.0f : 0.0f);
        }
        t.pixel_width = 2.0 / width;
        t.pixel_height = 2.0 / height;
        t.first_face = 2;
        t.flat = run.set % 4 == 1;
        t.two_sided = run.set % 3 != 0;
        t.normals_agree = run.set % 2 == 0;
        t.mirrored = run.set % 5 == 2;
    }
    void set_targets(Case& run) {
        constexpr size_t size = size_t{width} * height;
        VisibleTriangles& t = triangles;
        t.width = width;
        t.albedo = run.random.bits();
        t.material = 0x1234567;
        t.id = 5;
        t.albedos = run.output<uint64_t>(size, Kind::bits);
        t.normals = run.output<uint32_t>(size, Kind::bits);
        t.materials = run.output<uint32_t>(size, Kind::bits);
        t.depths = run.output<float>(size, Kind::floats);
        t.extensions[0] = run.output<uint32_t>(4 * size, Kind::bits);
        t.extensions[1] = run.output<uint32_t>(4 * size, Kind::extensions);
        if (run.set % 2 == 1) t.emission = run.output<float>(4 * size, Kind::floats);
        if (run.set % 3 == 1) t.ids = run.output<uint32_t>(size, Kind::bits);
        if (run.set % 3 == 1) t.elements = run.output<uint32_t>(size, Kind::bits);
    }
    /// Where a point of a face is seen.
    VisiblePixel pixel_of(Case& run) const {
        const VisibleTriangles& t = triangles;
        const int face = int(t.first_face) + run.random.below(faces_ - int(t.first_face));
        float weights[3] = {run.random.unit(), run.random.unit(), 0.1f}, p[3] = {};
        const float sum = weights[0] + weights[1] + weights[2];
        for (int i = 0; i < 9; ++i) p[i % 3] += weights[i / 3] / sum * t.V[3 * t.F[3 * face + i / 3] + i % 3];
        const double w = 8 - double(p[2]), x = 1.9 * double(p[0]) / w, y = 2.4 * double(p[1]) / w;
        return {int((x + 1) / t.pixel_width), int((1 - y) / t.pixel_height), uint32_t(face) - t.first_face,
                0};
    }

    int faces_ = 0;
};

/// Runs `body` on a grid with the uniforms of a shader.
template <class Uniforms, class Body>
void check_triangles(std::string_view name, Body&& body) {
    all_sets(name, [&](Case& run) {
        const Uniforms uniforms = uniforms_of<Uniforms>(run);
        Grid grid(run);
        grid.triangles.shader = &uniforms;
        grid.triangles.extended = std::is_same_v<Uniforms, mesh_extended_uniforms>;
        body(run, grid);
    });
}

void hit_triangles(Case& run, const Grid& grid) {
    ElementHit hits[Grid::pixels];
    for (int i = 0; i < Grid::pixels; ++i) {
        const uni::vec3 n = run.direction({0, 0, 1.5f});
        const float u = run.random.unit(), v = (1 - u) * run.random.unit();
        hits[i] = {grid.places[i].face, u, v, {n.x, n.y, n.z}, run.random.between(0, 0.1f)};
    }
    HitSurfaces surfaces;
    constexpr size_t room = size_t{Grid::pixels} + stream_alignment;
    for (size_t i = 0; i < sizeof surfaces / sizeof(float*); ++i) {
        const float* numbers = run.output<float>(room, Kind::floats);
        std::memcpy(reinterpret_cast<std::byte*>(&surfaces) + i * sizeof numbers, &numbers, sizeof numbers);
    }
    kernels.shade_hits(grid.triangles, hits, Grid::pixels, surfaces);
}

void check_meshes() {
    const auto plain = [](Case&, Grid& grid) {
        grid.triangles.shader = nullptr;
        kernels.resolve_triangles(grid.triangles, grid.places, Grid::pixels);
    };
    const auto resolve = [](Case&, const Grid& grid) {
        kernels.resolve_triangles(grid.triangles, grid.places, Grid::pixels);
    };
    const auto alpha = [](Case& run, const Grid& grid) {
        kernels.alpha_of_triangles(grid.triangles, grid.places, Grid::pixels,
                                   run.output<float>(Grid::pixels, Kind::floats));
    };
    const auto casters = [](Case& run, const Grid& grid) {
        kernels.casters_of_triangles(grid.triangles, grid.places, Grid::pixels,
                                     run.output<float>(4 * size_t(Grid::pixels), Kind::floats));
    };
    check_triangles<mesh_resolve_uniforms>("resolve_triangles,plain", plain);
    check_triangles<mesh_resolve_uniforms>("resolve_triangles", resolve);
    check_triangles<mesh_extended_uniforms>("resolve_triangles,extended", resolve);
    check_triangles<mesh_resolve_uniforms>("alpha_of_triangles", alpha);
    check_triangles<mesh_extended_uniforms>("alpha_of_triangles,extended", alpha);
    check_triangles<shadow_depth_uniforms>("casters_of_triangles", casters);
    check_triangles<mesh_resolve_uniforms>("shade_hits", hit_triangles);
    check_triangles<mesh_extended_uniforms>("shade_hits,extended", hit_triangles);
}

void check_lines() {
    constexpr int count = 40;
    all_sets("draw_lines", [&](Case& run) {
        const auto uniforms = uniforms_of<overlay_lines_uniforms>(run);
        Region region = region_of(run);
        if (uniforms.is_depth_only) {
            auto* depths = reinterpret_cast<std::byte*>(run.output<float>(width * height, Kind::floats));
            region.outputs[0] = {depths, Pixels::r32f};
        }
        ScreenLine lines[count];
        uint32_t chosen[count];
        for (int i = 0; i < count; ++i) {
            const uni::vec3 way = normalized({run.random.between(-1, 1), run.random.between(-1, 1), 0});
            lines[i] = {{run.random.between(0, width), run.random.between(0, height)},
                        {way.x, way.y},
                        run.random.between(0, 30),
                        {run.random.between(0.02f, 0.9f), run.random.between(0.02f, 0.1f)},
                        {run.random.unit(), run.random.unit(), run.random.unit(), run.random.unit()},
                        {run.random.unit(), run.random.unit(), run.random.unit(), run.random.unit()},
                        {run.random.between(0, 0.5f), run.random.between(0.5f, 1)},
                        {run.random.between(0.1f, 9), run.random.between(0.1f, 9)},
                        {run.random.between(-1, 2), run.random.between(-1, 2)},
                        i % 4 == 0 ? 0.75f : 0.25f,
                        {run.random.between(0, 20), i % 3 == 0 ? -1.0f : 1.0f}};
            chosen[i] = uint32_t((7 * i) % count);
        }
        constexpr int first = count / 2;
        const LineStroke strokes[2] = {{&uniforms, lines, chosen, first},
                                       {&uniforms, lines, chosen + first, count - first}};
        static float work[line_arrays * height * (width + stream_alignment)];
        kernels.draw_lines(strokes, 2, region, 1, height, work);
    });
}

}  // namespace
}  // namespace easypbr::native

int main() {
    using namespace easypbr::native;
    const FlushSubnormals flush;
#define EASYPBR_CHECK(name) check_shader<name##_uniforms>(#name, kernels.shade[size_t(Shader::name)]);
    EASYPBR_SHADERS(EASYPBR_CHECK)
#undef EASYPBR_CHECK
#define EASYPBR_CHECK(name) \
    check_stream<name##_uniforms, name##_stream>(#name, kernels.stream[size_t(Stream::name)]);
    EASYPBR_STREAMS(EASYPBR_CHECK)
#undef EASYPBR_CHECK
    check_meshes();
    check_lines();
    check_splats(kernels);
    check_clusters(kernels);
    check_pixels(kernels);
    check_map_directions(kernels);
    check_noisy_rows(kernels);
    check_paths(kernels);
    check_emitters(kernels);
    check_points(kernels);
    check_ellipses(kernels);
}
