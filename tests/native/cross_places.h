// The part of cross_kernels.cpp for kernels that evaluate no shader: they find and choose what others shade.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <vector>

#include "cross_inputs.h"

namespace easypbr::native {

inline void check_splats(const Kernels& kernels) {
    constexpr int count = 60, pixels = SplatPixels::size * SplatPixels::size;
    all_sets("blend_splats", [&](Case& run) {
        const auto number = [&](float low, float high) { return run.random.number(low, high); };
        auto* splats = run.array<ScreenSplat>(count);
        auto* places = run.array<uint32_t>(count);
        for (int i = 0; i < count; ++i) {
            const float wide = number(0.5f, 6), high = number(0.5f, 6), turn = number(-0.9f, 0.9f);
            const float part = 1 / (1 - turn * turn);
            splats[i] = {number(-4, 36),
                         number(-4, 36),
                         part / (wide * wide),
                         -part * turn / (wide * high),
                         part / (high * high),
                         number(0.01f, 1),
                         number(0, 1),
                         number(0, 1),
                         number(0, 1),
                         number(0.01f, 0.5f),
                         number(-0.01f, 0.01f),
                         number(-0.01f, 0.01f),
                         3 * wide,
                         3 * high,
                         number(10, 1000),
                         uint32_t(i)};
            places[i] = uint32_t((7 * i) % count);
        }
        SplatPixels tile{.left = 8, .top = 16, .is_soft = run.set % 2 == 0, .axis = {0.1f, 0.2f, -1, 0}};
        for (float** channel : {&tile.red, &tile.green, &tile.blue, &tile.through})
            *channel = run.output<float>(pixels, Kind::floats);
        tile.median = run.output<uint32_t>(pixels, Kind::bits);
        if (run.set % 3 != 0) {
            tile.farthest = run.floats(pixels, -0.1f, 0.2f);
            tile.nearest = run.floats(pixels, 0.2f, 0.6f);
        }
        if (run.set % 5 < 2) tile.positions = run.output<float>(pixels, Kind::floats);
        kernels.blend_splats(tile, splats, places, count);
    });
}

/// A camera that looks along -z, at numbers between -1 and 1 that are 3 away.
inline void set_view(float (&clip)[4][4]) {
    const float matrix[4][4] = {{1.5f, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 0, -1}, {0, 0, 0.1f, 3}};
    std::memcpy(clip, matrix, sizeof matrix);
}

inline void check_clusters(const Kernels& kernels) {
    constexpr int vertices = 203, faces = 250;
    all_sets("set_up_cluster", [&](Case& run) {
        auto* corners = run.array<uint8_t>(3 * faces + stream_alignment);
        for (int i = 0; i < 3 * faces; ++i) corners[i] = uint8_t(run.random.below(vertices));
        // Small enough to be kept, but in the last set.
        const float reach = run.set % 5 == 4 ? 1.0f : 0.2f;
        ClusterFaces cluster{.vertices = run.floats(3 * vertices + stream_alignment, -reach, reach),
                             .corners = corners,
                             .vertex_count = vertices,
                             .face_count = faces,
                             .half_width = 320,
                             .half_height = 240,
                             .left = 300,
                             .top = 200,
                             .right = 330,
                             .bottom = 250,
                             .both_sides = run.set % 3 == 0,
                             .mirrored = run.set % 2 == 0};
        set_view(cluster.clip_from_mesh);
        auto* count = run.output<int32_t>(1, Kind::bits);
        auto* kept = run.output<uint8_t>(faces, Kind::bits);
        auto* depths = run.output<float>(vertices, Kind::floats);
        auto* extent = run.output<int32_t>(4, Kind::bits);
        auto* nearest = run.output<float>(1, Kind::floats);
        ClusterScreen screen;
        *count = -1;
        if (!kernels.project_cluster(cluster, screen)) return;
        std::copy_n(screen.depth, vertices, depths);
        const int32_t found[] = {screen.left, screen.top, screen.right, screen.bottom};
        std::copy_n(found, 4, extent);
        *nearest = screen.nearest;
        *count = kernels.set_up_cluster(cluster, screen);
        if (*count > 0) std::memcpy(kept, screen.kept, size_t(*count));
    });
}

inline void check_points(const Kernels& kernels) {
    constexpr int count = 199;
    all_sets("set_up_points", [&](Case& run) {
        PointBatch batch{.points = run.floats(3 * count + stream_alignment, -1, 1),
                         .count = count,
                         .half_width = 320,
                         .half_height = 240,
                         .left = 200,
                         .top = 100,
                         .right = 500,
                         .bottom = 300,
                         .pixels = 0.3f + 0.4f * float(run.set % 5),
                         .world_pixels = run.set % 2 == 0 ? 0.0f : 4.0f,
                         .round = run.set % 3 != 0};
        set_view(batch.clip_from_mesh);
        constexpr size_t pixels = 300 * 200;
        auto* seen = run.array<uint64_t>(pixels);
        for (size_t i = 0; i < pixels; ++i)
            seen[i] = uint64_t(std::bit_cast<uint32_t>(0.1f * float(run.random.below(10)))) << 32;
        if (run.set % 4 != 3) batch.seen = seen;
        auto* found = run.output<int32_t>(1 + 4 * count, Kind::bits);
        auto* depths = run.output<float>(count, Kind::floats);
        PointScreen screen;
        found[0] = kernels.set_up_points(batch, screen);
        for (int i = 0; i < found[0]; ++i) {
            const int at = screen.kept[i];
            depths[i] = screen.depth[at];
            found[1 + 4 * i] = at;
            found[2 + 4 * i] = screen.column[at];
            found[3 + 4 * i] = screen.line[at];
            found[4 + 4 * i] = screen.covered[at];
        }
    });
}

inline void check_ellipses(const Kernels& kernels) {
    constexpr int count = 199;
    all_sets("set_up_ellipses", [&](Case& run) {
        EllipseView view{.axial = {0, 0, -1, 3},
                         .eye = {0, 0, 3},
                         .towards_viewer = {0, 0, 1},
                         .orthographic = run.set % 3 == 0,
                         .width = 640,
                         .height = 480,
                         .near = 0.1f,
                         .normal_from_mesh = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                         .world_from_mesh = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}};
        set_view(view.clip_from_mesh);
        const EllipseBatch batch{
            .vectors = run.floats(EllipseBatch::components * count + stream_alignment, -0.4f, 0.4f),
            .count = count,
            .view = &view};
        auto* kept = run.output<int32_t>(1 + count, Kind::bits);
        auto* ellipses = run.output<float>(count * int(ProjectedEllipse<float>::members), Kind::floats);
        EllipseScreen screen;
        kept[0] = kernels.set_up_ellipses(batch, screen);
        for (int i = 0; i < kept[0]; ++i) {
            kept[1 + i] = screen.kept[i];
            for (const auto& member : screen.ellipses) *ellipses++ = member[screen.kept[i]];
        }
    });
}

inline void check_paths(const Kernels& kernels) {
    constexpr int count = 203, room = count + stream_alignment;
    all_sets("sample_paths", [&](Case& run) {
        const float *first = run.floats(room, 0, 1), *second = run.floats(room, 0, 1);
        std::vector<uint32_t> seeds(room), samples(room);
        std::memcpy(seeds.data(), first, sizeof(float) * room);
        std::memcpy(samples.data(), second, sizeof(float) * room);
        auto *xs = run.output<float>(room, Kind::floats), *ys = run.output<float>(room, Kind::floats);
        kernels.sample_paths(seeds.data(), samples.data(), uint32_t(run.set), count, xs, ys);
        std::fill(xs + count, xs + room, 0.0f);
        std::fill(ys + count, ys + room, 0.0f);
    });
}

inline void check_pixels(const Kernels& kernels) {
    constexpr int count = 203, room = count + stream_alignment;
    all_sets("find_places", [&](Case& run) {
        CameraRays rays{.orthographic = run.set % 2 == 1, .near = 0.5, .far = 20, .width = 0.01};
        for (double* way : {rays.first, rays.column, rays.row, rays.back, rays.eye})
            for (int c = 0; c < 3; ++c) way[c] = double(run.random.number(-1, 1));
        rays.towards[2] = 1;
        std::vector<int32_t> columns(room), rows(room);
        for (int i = 0; i < room; ++i) {
            columns[size_t(i)] = 7 * i;
            rows[size_t(i)] = i / 16;
        }
        const auto bits = [&] { return run.filled<uint32_t>(room, [&] { return run.random.bits(); }); };
        const PixelSurfaces pixels{columns.data(), rows.data(), run.floats(room, 0.01f, 0.9f), bits(), bits(),
                                   bits(),         bits()};
        CameraPlaces to;
        std::vector<float*> outputs;
        const auto output = [&](float*& values) {
            values = run.output<float>(room, Kind::floats);
            outputs.push_back(values);
        };
        for (auto* vector : {&to.position, &to.view, &to.normal, &to.albedo})
            for (float*& values : *vector) output(values);
        for (float*& values : to.parameters) output(values);
        output(to.footprint);
        kernels.find_places(rays, pixels, count, to);
        for (float* values : outputs) std::fill(values + count, values + room, 0.0f);
    });
}

inline void check_map_directions(const Kernels& kernels) {
    constexpr int count = 203, room = count + stream_alignment;
    all_sets("map_directions", [&](Case& run) {
        float rotation[3][3];
        for (auto& column : rotation)
            for (float& value : column) value = run.random.between(-1, 1);
        const float* directions[3];
        for (const float*& values : directions) values = run.floats(room, -1, 1);
        float* numbers[5];
        for (float*& values : numbers) values = run.output<float>(room, Kind::floats);
        kernels.find_map_places(rotation, directions, count, numbers[0], numbers[1]);
        kernels.find_map_directions(rotation, numbers[0], directions[0], directions[1], count,
                                    {numbers[2], numbers[3], numbers[4]});
        for (float* values : numbers) std::fill(values + count, values + room, 0.0f);
    });
}

inline void check_noisy_rows(const Kernels& kernels) {
    constexpr int pixels = NoisyRow::pixels;
    all_sets("add_noisy_row", [&](Case& run) {
        NoisyTile tile;
        auto* beside = run.output<float>(4 * pixels, Kind::floats);
        std::fill(beside, beside + 4 * pixels, 0.0f);
        const auto bits = [&] { return run.random.bits(); };
        for (int i = 0; i < 15; ++i) {
            NoisyRow row;
            row.sample = run.floats(4 * pixels, 0, 2);
            row.normal = run.filled<uint32_t>(pixels, bits);
            row.material = run.filled<uint32_t>(pixels, bits);
            row.albedo = run.filled<uint64_t>(pixels, bits);
            row.depth = run.floats(pixels, -0.2f, 1);
            if (run.set % 3 == 1) row.open = run.floats(pixels, 0, 1);
            row.end_of_lit = 100;
            row.catcher = 120;
            row.orthographic = run.set % 2 == 1;
            row.over_nothing = run.set % 4 < 2;
            BesideNoisy found;
            kernels.add_noisy_row(row, i % 3, tile, found);
            for (int c = 0; c < 4; ++c)
                for (int x = 0; x < pixels; ++x) beside[pixels * c + x] += found.radiance[c][x];
        }
        constexpr size_t floats = offsetof(NoisyTile, frames), rest = sizeof tile - floats;
        std::memcpy(run.output<float>(floats / sizeof(float), Kind::floats), &tile, floats);
        std::memcpy(run.output<uint8_t>(rest, Kind::bits), reinterpret_cast<const char*>(&tile) + floats,
                    rest);
    });
}

inline void check_emitters(const Kernels& kernels) {
    constexpr int count = 203, room = count + stream_alignment;
    all_sets("emitters", [&](Case& run) {
        FewEmitters e;
        e.count = 1 + 4 * run.set;
        const auto fill = [&](float(&to)[FewEmitters::room], float low, float high) {
            std::copy_n(run.floats(FewEmitters::room, low, high), FewEmitters::room, to);
        };
        for (int c = 0; c < 3; ++c) {
            for (auto* to : {&e.centre, &e.normal, &e.corner, &e.edge1, &e.edge2}) fill((*to)[c], -1, 1);
            fill(e.least[c], -1, 0.5f);
            fill(e.most[c], 0, 1);
        }
        fill(e.area, 0.1f, 1);
        fill(e.light, 0, 1);
        EmitterPlaces places{{}, run.floats(room, 0, 1), run.floats(room, 0, 1)};
        for (const float*& from : places.from) from = run.floats(room, -2, 2);
        EmitterPoints to;
        to.chosen = run.output<int32_t>(room, Kind::bits);
        for (float** values : {&to.u, &to.v, &to.direction[0], &to.direction[1], &to.direction[2],
                               &to.distance, &to.cosine, &to.density})
            *values = run.output<float>(room, Kind::floats);
        float* chances = run.output<float>(room, Kind::floats);
        kernels.sample_emitters(e, places, count, to);
        kernels.chances_of_emitters(e, places.from, to.chosen, count, chances);
        std::fill(to.chosen + count, to.chosen + room, 0);
        for (float* values : {to.u, to.v, to.direction[0], to.direction[1], to.direction[2], to.distance,
                              to.cosine, to.density, chances})
            std::fill(values + count, values + room, 0.0f);
    });
}

}  // namespace easypbr::native
