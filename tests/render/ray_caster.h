// An independent oracle for shadows: visibility by casting rays through a hierarchy of boxes.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "easypbr/scene/scene.h"

namespace easypbr {

/// Triangles of a snapshot in world space.
class RayCaster {
  public:
    explicit RayCaster(const SceneSnapshot& scene) {
        for (const auto& object : scene.objects) {
            const MeshData& mesh = *object.mesh;
            for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
                Triangle t;
                for (int k = 0; k < 3; ++k)
                    t.corner[k] =
                        object.T_world_mesh * Vec3d(mesh.V.row(mesh.F(f, k)).transpose().cast<double>());
                triangles_.push_back(t);
            }
        }
        if (!triangles_.empty()) build(0, triangles_.size());
    }

    /// Whether anything lies between two points, their neighbourhoods (a part `margin` of the way) left out.
    bool blocked(const Vec3d& from, const Vec3d& to, double margin = 1e-6) const {
        const Ray ray{from, to - from, (to - from).cwiseInverse(), margin, 1 - margin};
        return !nodes_.empty() && hit(0, ray);
    }

  private:
    struct Triangle {
        Vec3d corner[3];
        Vec3d middle() const { return (corner[0] + corner[1] + corner[2]) / 3; }
    };
    struct Node {
        Box3d box;
        size_t first = 0, count = 0;  ///< of a leaf
        size_t children[2] = {0, 0};
    };
    struct Ray {
        Vec3d origin, direction, inverse;
        double from, to;
    };

    size_t build(size_t begin, size_t end) {
        const size_t index = nodes_.size();
        nodes_.emplace_back();
        Box3d box;
        for (size_t i = begin; i < end; ++i)
            for (const Vec3d& c : triangles_[i].corner) box.extend(c);
        nodes_[index].box = box;
        if (end - begin <= 4) {
            nodes_[index].first = begin;
            nodes_[index].count = end - begin;
            return index;
        }
        Eigen::Index axis = 0;
        box.sizes().maxCoeff(&axis);
        const size_t middle = (begin + end) / 2;
        std::nth_element(triangles_.begin() + long(begin), triangles_.begin() + long(middle),
                         triangles_.begin() + long(end), [axis](const Triangle& a, const Triangle& b) {
                             return a.middle()[axis] < b.middle()[axis];
                         });
        const size_t left = build(begin, middle), right = build(middle, end);
        nodes_[index].children[0] = left;
        nodes_[index].children[1] = right;
        return index;
    }

    static bool meets(const Box3d& box, const Ray& ray) {
        double from = ray.from, to = ray.to;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (box.min()[axis] - ray.origin[axis]) * ray.inverse[axis],
                         b = (box.max()[axis] - ray.origin[axis]) * ray.inverse[axis];
            // A ray within a plane of the box divides 0 by 0: the comparison keeps the old bound.
            from = std::max(from, std::min(a, b));
            to = std::min(to, std::max(a, b));
        }
        return from <= to * (1 + 1e-12);
    }

    /// Moeller and Trumbore 1997.
    static bool meets(const Triangle& t, const Ray& ray) {
        const Vec3d e1 = t.corner[1] - t.corner[0], e2 = t.corner[2] - t.corner[0];
        const Vec3d p = ray.direction.cross(e2);
        const double det = e1.dot(p);
        if (det == 0) return false;
        const Vec3d s = ray.origin - t.corner[0], q = s.cross(e1);
        const double u = s.dot(p) / det, v = ray.direction.dot(q) / det, at = e2.dot(q) / det;
        return u >= 0 && v >= 0 && u + v <= 1 && at > ray.from && at < ray.to;
    }

    bool hit(size_t index, const Ray& ray) const {
        const Node& node = nodes_[index];
        if (!meets(node.box, ray)) return false;
        for (size_t i = node.first; i < node.first + node.count; ++i)
            if (meets(triangles_[i], ray)) return true;
        return node.count == 0 && (hit(node.children[0], ray) || hit(node.children[1], ray));
    }

    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
};

}  // namespace easypbr
