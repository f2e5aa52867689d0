#include "easypbr/dataset/instances.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "easypbr/core/parallel.h"
#include "easypbr/core/suggest.h"

namespace easypbr::dataset {
namespace {

/// The name in the scene that a node belongs to.
const std::string& root_of(const SceneSnapshot::Object& object) {
    return object.root.empty() ? object.name : object.root;
}

void extend_by_vertices(Box3d& box, const Eigen::Affine3d& T_obj_mesh, const MeshData& mesh,
                        const MeshPart* part) {
    const bool moved = !T_obj_mesh.matrix().isIdentity(1e-12);
    const auto add = [&](Eigen::Index v) {
        const Vec3d p = Vec3(mesh.V.row(v)).cast<double>();
        box.extend(moved ? Vec3d(T_obj_mesh * p) : p);
    };
    if (part)
        for (int i = 3 * part->first_face; i < 3 * (part->first_face + part->face_count); ++i)
            add(mesh.F.data()[i]);
    else if (moved)
        for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) add(v);
    else if (!mesh.V.empty())
        box.extend(Box3d(Vec3d(mesh.V.colwise().minCoeff().transpose().cast<double>()),
                         Vec3d(mesh.V.colwise().maxCoeff().transpose().cast<double>())));
}

/// By the cells that hold vertices, each of which is drawn as a cube (see voxel_mesh()).
void extend_by_voxels(Box3d& box, const Eigen::Affine3d& T_obj_mesh, const MeshData& mesh, double size) {
    if (mesh.V.empty()) return;
    const Vec3d origin = mesh.V.row(0).transpose().cast<double>();
    const auto centre_of = [&](const Vec3d& p) {
        return Vec3d(origin + size * ((p - origin) / size)
                                         .array()
                                         .unaryExpr([](double cell) { return std::floor(cell + 0.5); })
                                         .matrix());
    };
    if (T_obj_mesh.matrix().isIdentity(1e-12)) {
        const Vec3d low = mesh.V.colwise().minCoeff().transpose().cast<double>(),
                    high = mesh.V.colwise().maxCoeff().transpose().cast<double>();
        const Vec3d half = Vec3d::Constant(size / 2);
        box.extend(Box3d(Vec3d(centre_of(low) - half), Vec3d(centre_of(high) + half)));
        return;
    }
    const Vec3d half = T_obj_mesh.linear().cwiseAbs().rowwise().sum() * (size / 2);
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
        const Vec3d centre = T_obj_mesh * centre_of(mesh.V.row(v).transpose().cast<double>());
        box.extend(Box3d(Vec3d(centre - half), Vec3d(centre + half)));
    }
}

PixelBox box_of(int x0, int y0, int x1, int y1) {
    return x1 < x0 || y1 < y0 ? PixelBox{} : PixelBox{x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

/// Least and largest pixels so far.
struct Extent {
    int x0 = std::numeric_limits<int>::max(), y0 = x0, x1 = std::numeric_limits<int>::min(), y1 = x1;
    void add(int x, int y) {
        x0 = std::min(x0, x);
        x1 = std::max(x1, x);
        y0 = std::min(y0, y);
        y1 = std::max(y1, y);
    }
    PixelBox box() const { return box_of(x0, y0, x1, y1); }
};

bool overlap(const PixelBox& a, const PixelBox& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

PixelBox united(const PixelBox& a, const PixelBox& b) {
    if (a.width == 0 || b.width == 0) return a.width == 0 ? b : a;
    return box_of(std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.x + a.width, b.x + b.width) - 1,
                  std::max(a.y + a.height, b.y + b.height) - 1);
}

bool contains(Vec2i size, const PixelBox& box) {
    return box.x >= 0 && box.y >= 0 && box.x + box.width <= size.x() && box.y + box.height <= size.y();
}

void add_geometry(Instance& instance, const Surfaces& s) {
    const Eigen::Affine3d T_cv_world =
        Eigen::Affine3d(s.camera.opencv_T_world_cam()).inverse(Eigen::Isometry);
    instance.T_cam_obj = T_cv_world * instance.T_world_obj;
    const double reach = lens_reach(s.camera);
    for (int i = 0; i < 8; ++i) {
        const Vec3d corner =
            instance.box.isEmpty() ? Vec3d(Vec3d::Zero()) : instance.box.corner(Box3d::CornerType(i));
        const Vec3d seen = instance.T_cam_obj * corner;
        instance.corners_world.row(i) = instance.T_world_obj * corner;
        instance.corners_cam.row(i) = seen;
        const bool is_shown = is_projected(s.camera, reach, seen);
        instance.corners_px.row(i) = is_shown
                                         ? project(s.camera, s.size, seen)
                                         : Vec2d(Vec2d::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
}

void count_visible(std::vector<Instance>& instances, const Surfaces& s, const InstanceTable& table) {
    std::vector<Extent> extents(instances.size());
    for (size_t i = 0; i < s.object.size(); ++i) {
        if (!s.covered(i)) continue;
        const size_t k = table.of(s.object[i] - 1, s.part[i]);
        ++instances[k].pixels_visible;
        extents[k].add(int(i) % s.size.x(), int(i) / s.size.x());
    }
    for (size_t k = 0; k < instances.size(); ++k)
        if (instances[k].pixels_visible) instances[k].box_visible = extents[k].box();
}

/// Pixels of the drawn picture that an instance may cover if it is alone, at most three times the picture.
/// `beyond`: how far its primitives reach beyond the box.
PixelBox reach_of(const Instance& instance, const app::LensMap& lens, const Camera& drawn,
                  const render::ScreenReach& beyond) {
    const Vec2i size = lens.drawn_size;
    if (instance.box.isEmpty()) return {};
    const double nearest = instance.corners_cam.col(2).minCoeff() - beyond.world;
    if (instance.corners_cam.col(2).maxCoeff() + beyond.world <= drawn.near) return {};
    const Vec2d least = -size.cast<double>(), most = 2.0 * size.cast<double>() - Vec2d(1, 1);
    Vec2d low = least, high = most;
    if (nearest > drawn.near) {
        Vec2d corner_low = Vec2d::Constant(1e30), corner_high = -corner_low;
        double steepest = 0;
        for (int i = 0; i < 8; ++i) {
            const Vec3d p = instance.corners_cam.row(i);
            const Vec2d pixel = project(drawn, size, p);
            corner_low = corner_low.cwiseMin(pixel);
            corner_high = corner_high.cwiseMax(pixel);
            steepest = std::max(steepest, p.head<2>().norm() / p.z());
        }
        double pixels_per_unit = size.y() / drawn.ortho_height;
        if (drawn.projection == Projection::perspective) {
            // A step of length 1 along the ray and across moves a point by this at the least depth.
            const Mat3d K = drawn.opencv_K(size.x(), size.y());
            pixels_per_unit = std::max(K(0, 0), K(1, 1)) * (1 + steepest) / nearest;
        }
        const Vec2d margin = Vec2d::Constant(2 + beyond.pixels + beyond.world * pixels_per_unit);
        low = (corner_low - margin).cwiseMax(least);
        high = (corner_high + margin).cwiseMin(most);
    }
    return box_of(int(std::floor(low.x())), int(std::floor(low.y())), int(std::ceil(high.x())),
                  int(std::ceil(high.y())));
}

/// Counts of the instance alone in the pixels that were drawn.
void count_amodal(Instance& instance, const PixelBox& area, const std::vector<uint8_t>& alone, Vec2i size) {
    Extent extent;
    for (size_t i = 0; i < alone.size(); ++i) {
        if (!alone[i]) continue;
        const int x = area.x + int(i) % area.width, y = area.y + int(i) / area.width;
        ++instance.pixels_amodal;
        instance.pixels_amodal_inside += x >= 0 && y >= 0 && x < size.x() && y < size.y();
        extent.add(x, y);
    }
    if (instance.pixels_amodal) instance.box_amodal = extent.box();
}

Bitmap inside_picture(const PixelBox& area, const std::vector<uint8_t>& alone, Vec2i size) {
    const int x0 = std::max(0, area.x), y0 = std::max(0, area.y);
    const int x1 = std::min(size.x(), area.x + area.width), y1 = std::min(size.y(), area.y + area.height);
    if (x1 <= x0 || y1 <= y0) return {};
    Bitmap bitmap{{x0, y0, x1 - x0, y1 - y0}, {}};
    for (int y = y0; y < y1; ++y) {
        const auto row = alone.begin() + long(y - area.y) * area.width + (x0 - area.x);
        bitmap.pixels.insert(bitmap.pixels.end(), row, row + (x1 - x0));
    }
    return bitmap;
}

/// The same through a lens: what is inside is looked up in the picture that was drawn.
void count_warped(Instance& instance, const PixelBox& area, const std::vector<uint8_t>& alone,
                  const app::LensMap& lens, const Surfaces& s) {
    instance.amodal = {{0, 0, lens.size.x(), lens.size.y()}, std::vector<uint8_t>(lens.source.size())};
    Extent extent;
    for (size_t i = 0; i < lens.source.size(); ++i) {
        const int drawn = int(lens.nearest(i));
        const int x = drawn % lens.drawn_size.x() - area.x, y = drawn / lens.drawn_size.x() - area.y;
        if (x < 0 || y < 0 || x >= area.width || y >= area.height) continue;
        if (!alone[size_t(y) * size_t(area.width) + size_t(x)]) continue;
        instance.amodal.pixels[i] = 1;
        ++instance.pixels_amodal_inside;
        extent.add(int(i) % lens.size.x(), int(i) / lens.size.x());
    }
    // Outside of the picture pixels are of another size: parts are compared in the drawn picture.
    int all = 0, inside = 0;
    const double reach = lens_reach(s.camera);
    const Intrinsics& k = *lens.drawn.intrinsics;
    for (size_t i = 0; i < alone.size(); ++i) {
        if (!alone[i]) continue;
        ++all;
        const int x = area.x + int(i) % area.width, y = area.y + int(i) / area.width;
        const Vec3d ray((x - k.cx) / k.fx, (y - k.cy) / k.fy, 1);
        const Vec2d pixel = project(s.camera, s.size, ray);
        const bool in_picture = pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < s.size.x() - 0.5 &&
                                pixel.y() < s.size.y() - 0.5;
        const bool in_drawn = contains(lens.drawn_size, {x, y, 1, 1});
        inside += in_drawn && in_picture;
        if (!in_picture && ray.head<2>().norm() < reach)
            extent.add(int(std::lround(pixel.x())), int(std::lround(pixel.y())));
    }
    if (all) instance.box_amodal = extent.box();
    instance.pixels_amodal =
        inside ? int(std::lround(double(instance.pixels_amodal_inside) * all / inside)) : all;
}

/// The instance's amodal bitmap, box and pixels: what it covers if it is alone.
void count_alone(Instance& instance, const PixelBox& area, const app::Drawn& drawn, const Surfaces& s,
                 const InstanceTable& table, size_t place) {
    const auto alone = drawn.coverage(area, [&](size_t object, int first_face) {
        const auto& parts = s.scene.objects[object].mesh->parts;
        size_t part = 0;
        while (part + 1 < parts.size() && parts[part].first_face != first_face) ++part;
        return table.of(object, part) == place;
    });
    if (!drawn.lens().is_identity()) return count_warped(instance, area, alone, drawn.lens(), s);
    instance.amodal = inside_picture(area, alone, s.size);
    count_amodal(instance, area, alone, s.size);
}

/// The same bitmap of a larger rectangle, where it does not hold `box`.
void hold(Bitmap& bitmap, const PixelBox& box) {
    const PixelBox from = bitmap.area;
    if (box.x >= from.x && box.y >= from.y && box.x + box.width <= from.x + from.width &&
        box.y + box.height <= from.y + from.height)
        return;
    const PixelBox area = united(from, box);
    std::vector<uint8_t> pixels(size_t(area.width) * size_t(area.height));
    for (int y = 0; y < from.height; ++y)
        std::copy_n(bitmap.pixels.begin() + long(y) * from.width, from.width,
                    pixels.begin() + long(from.y + y - area.y) * area.width + (from.x - area.x));
    bitmap = {area, std::move(pixels)};
}

/// A pixel that is seen is covered, whatever the rounding of two projections says.
void add_visible(Instance& instance, const Surfaces& s, const InstanceTable& table, size_t place) {
    const PixelBox& seen = instance.box_visible;
    if (seen.width == 0) return;
    Bitmap& bitmap = instance.amodal;
    hold(bitmap, seen);
    for (int y = seen.y; y < seen.y + seen.height; ++y)
        for (int x = seen.x; x < seen.x + seen.width; ++x) {
            const size_t i = size_t(y) * size_t(s.size.x()) + size_t(x);
            if (!s.covered(i) || table.of(s.object[i] - 1, s.part[i]) != place) continue;
            const int u = x - bitmap.area.x, v = y - bitmap.area.y;
            uint8_t& pixel = bitmap.pixels[size_t(v) * size_t(bitmap.area.width) + size_t(u)];
            instance.pixels_amodal += !pixel;
            instance.pixels_amodal_inside += !pixel;
            pixel = 1;
        }
    instance.box_amodal = united(instance.box_amodal, seen);
}

Bitmap visible_bitmap(const Instance& instance, const Surfaces& s, const InstanceTable& table, size_t place) {
    Bitmap bitmap{instance.box_visible, {}};
    const PixelBox& box = bitmap.area;
    for (int y = box.y; y < box.y + box.height; ++y)
        for (int x = box.x; x < box.x + box.width; ++x) {
            const size_t i = size_t(y) * size_t(s.size.x()) + size_t(x);
            bitmap.pixels.push_back(s.covered(i) && table.of(s.object[i] - 1, s.part[i]) == place);
        }
    return bitmap;
}

void take_visible(Instance& instance) {
    instance.amodal = instance.visible;
    instance.pixels_amodal = instance.pixels_amodal_inside = instance.pixels_visible;
    instance.box_amodal = instance.box_visible;
}

/// Instances with a surface that may be seen through: it covers more than where it is seen.
std::vector<bool> blended_instances(const std::vector<bool>& objects, const SceneSnapshot& scene,
                                    const InstanceTable& table) {
    std::vector<bool> instances(table.instances().size());
    for (size_t o = 0; o < objects.size(); ++o)
        for (size_t p = 0; objects[o] && p < std::max<size_t>(1, scene.objects[o].mesh->parts.size()); ++p)
            instances[table.of(o, p)] = true;
    return instances;
}

/// Instances whose reach no other's touches are seen whole, as long as they are inside of the picture.
bool seen_whole(const std::vector<PixelBox>& reaches, size_t place, const app::LensMap& lens) {
    if (!lens.is_identity() || !contains(lens.size, reaches[place])) return false;
    for (size_t k = 0; k < reaches.size(); ++k)
        if (k != place && overlap(reaches[k], reaches[place])) return false;
    return true;
}

}  // namespace

InstancesBy instances_by_named(const std::string& name) {
    static const std::vector<std::string> names = {"object", "node", "part"};
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
        throw NameError(fmt::format("instances cannot be told apart by '{}'{}: expected {}", name,
                                    did_you_mean(name, names), fmt::join(names, ", ")));
    return InstancesBy(found - names.begin());
}

InstanceTable::InstanceTable(const SceneSnapshot& scene, InstancesBy by,
                             const std::map<std::string, int>& classes) {
    std::set<std::string> taken;
    std::map<std::string, size_t> roots;  // places, where an object is one instance with its children
    for (const auto& object : scene.objects) taken.insert(root_of(object));
    const auto add = [&](const std::string& name, const SceneSnapshot::Object& object) {
        Instance instance;
        instance.id = int(instances_.size()) + 1;
        instance.name = name;
        const auto own = classes.find(name), of_root = classes.find(root_of(object));
        instance.semantic_id = own != classes.end()       ? own->second
                               : of_root != classes.end() ? of_root->second
                                                          : 0;
        instance.T_world_obj = object.T_world_mesh;
        instances_.push_back(instance);
        return instances_.size() - 1;
    };
    std::map<std::string, int> numbers;  // the last that was given to a name
    /// With a number where another instance, or what the scene shows, has the name.
    const auto free_name = [&](const std::string& name) {
        std::string free = name;
        if (taken.insert(free).second) return free;
        int& number = numbers.try_emplace(name, 1).first->second;
        do free = fmt::format("{}#{}", name, ++number);
        while (!taken.insert(free).second);
        return free;
    };
    for (const auto& object : scene.objects) {
        const std::string& root = root_of(object);
        std::vector<size_t> row;
        const std::vector<MeshPart>& parts = object.mesh->parts;
        const bool in_parts = by == InstancesBy::part && parts.size() > 1;
        for (size_t p = 0; p < (in_parts ? parts.size() : 1); ++p) {
            size_t place = instances_.size();
            if (by == InstancesBy::object) {
                const auto [found, is_new] = roots.emplace(root, place);
                place = is_new ? add(root, object) : found->second;
            } else if (in_parts) {
                const std::string part = parts[p].name.empty() ? std::to_string(p) : parts[p].name;
                add(free_name(fmt::format("{}:{}", object.name, part)), object);
            } else {
                // Parents come first: the first node of a hierarchy is what the scene shows.
                const bool is_shown = roots.emplace(root, place).second;
                add(is_shown ? root : free_name(object.name), object);
            }
            extend(place, object, in_parts ? &parts[p] : nullptr, 0);
            row.push_back(place);
        }
        roots.emplace(root, row.front());
        table_.push_back(std::move(row));
    }
}

InstanceTable::InstanceTable(const Surfaces& s, InstancesBy by, const std::map<std::string, int>& classes)
    : InstanceTable(s.scene, by, classes) {
    for (size_t o = 0; o < s.scene.objects.size(); ++o)
        if (s.voxel_sizes[o] > 0 || (by == InstancesBy::part && !s.only_faces[o]))
            extend(of(o, 0), s.scene.objects[o], nullptr, s.voxel_sizes[o]);
}

void InstanceTable::extend(size_t place, const SceneSnapshot::Object& object, const MeshPart* part,
                           double voxel_size) {
    Instance& instance = instances_[place];
    const Eigen::Affine3d T_obj_mesh = inverse_pose(instance.T_world_obj) * object.T_world_mesh;
    if (voxel_size > 0)
        extend_by_voxels(instance.box, T_obj_mesh, *object.mesh, voxel_size);
    else
        extend_by_vertices(instance.box, T_obj_mesh, *object.mesh, part);
}

std::vector<Instance> annotate(const app::Drawn& drawn, const Surfaces& s, const InstanceTable& table,
                               bool amodal) {
    std::vector<Instance> instances = table.instances();
    for (Instance& instance : instances) add_geometry(instance, s);
    count_visible(instances, s, table);
    for (size_t k = 0; k < instances.size(); ++k) {
        instances[k].picture = s.size;
        instances[k].visible = visible_bitmap(instances[k], s, table, k);
    }
    const app::LensMap& lens = drawn.lens();
    const Camera camera = lens.is_identity() ? s.camera : lens.drawn;
    std::vector<render::ScreenReach> beyond(instances.size());
    const std::vector<render::ScreenReach> of_objects = drawn.reaches();
    for (size_t o = 0; o < of_objects.size(); ++o) beyond[table.of(o, 0)].extend(of_objects[o]);
    const std::vector<bool> blended = blended_instances(drawn.blended(), s.scene, table);
    std::vector<PixelBox> reaches;
    for (size_t k = 0; k < instances.size(); ++k)
        reaches.push_back(reach_of(instances[k], lens, camera, beyond[k]));
    for (size_t k = 0; k < instances.size(); ++k) {
        Instance& instance = instances[k];
        const PixelBox& area = reaches[k];
        if (!amodal || (!blended[k] && seen_whole(reaches, k, lens))) {
            take_visible(instance);
        } else {
            if (area.width > 0) count_alone(instance, area, drawn, s, table, k);
            add_visible(instance, s, table, k);
        }
        if (instance.pixels_amodal == 0) continue;
        instance.visible_fraction = double(instance.pixels_visible) / instance.pixels_amodal;
        instance.truncation = 1 - double(instance.pixels_amodal_inside) / instance.pixels_amodal;
    }
    return instances;
}

}  // namespace easypbr::dataset
