// SPDX-License-Identifier: BSD-3-Clause
#include "support/scenes.hpp"

#include <algorithm>
#include <cmath>

namespace edgevox::test {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.25;  // between samples of a surface [voxel]
constexpr double kPi = 3.14159265358979323846;

double distanceTo(const Segment& segment, const Vector3d& point) {
  const Vector3d along = segment.to - segment.from;
  const double t = (point - segment.from).dot(along) / along.squaredNorm();
  return (segment.from + std::clamp(t, 0.0, 1.0) * along - point).norm();
}

double nearestOf(const std::vector<Segment>& segments, const VoxelIndex& v) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Segment& segment : segments) {
    nearest = std::min(nearest, distanceTo(segment, voxelCentre(v, 1.0)));
  }
  return nearest;
}

/// The parallelogram at `origin` between `u` and `v`; noise along its normal.
void samplePatch(Scene& scene, Random& random, const Vector3d& origin, const Vector3d& u,
                 const Vector3d& v, double sigma) {
  const Vector3d normal = u.cross(v).normalized();
  const int u_steps = static_cast<int>(std::ceil(u.norm() / kStep));
  const int v_steps = static_cast<int>(std::ceil(v.norm() / kStep));
  for (int i = 0; i <= u_steps; ++i) {
    for (int j = 0; j <= v_steps; ++j) {
      const Vector3d on_patch = origin + u * (double(i) / u_steps) + v * (double(j) / v_steps);
      const double noise = sigma > 0.0 ? sigma * random.normal() : 0.0;
      scene.points.push_back(on_patch + noise * normal);
    }
  }
}

void fillVoxels(Scene& scene) {
  scene.voxels.clear();
  for (const Vector3d& point : scene.points) scene.voxels.push_back(voxelAt(point, 1.0));
  scene.voxels = sorted(std::move(scene.voxels));
}

/// Turns the scene about the origin and moves it by less than a voxel.
Scene anyhow(Random& random, Scene scene) {
  const Eigen::Matrix3d rotation = random.rotation();
  const Vector3d offset = random.vectorIn(0.0, 1.0);
  const auto move = [&](Vector3d& point) { point = rotation * point + offset; };
  for (Vector3d& point : scene.points) move(point);
  for (Vector3d& corner : scene.corners) move(corner);
  for (auto* segments : {&scene.creases, &scene.rims}) {
    for (Segment& segment : *segments) {
      move(segment.from);
      move(segment.to);
    }
  }
  fillVoxels(scene);
  return scene;
}

/// Adds the six faces of a box and its twelve edges as creases.
void addBox(Scene& scene, Random& random, const Vector3d& low, const Vector3d& size, double sigma) {
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d u = Vector3d::Unit((axis + 1) % 3) * size[(axis + 1) % 3];
    const Vector3d v = Vector3d::Unit((axis + 2) % 3) * size[(axis + 2) % 3];
    const Vector3d across = Vector3d::Unit(axis) * size[axis];
    for (const Vector3d& origin : {low, Vector3d(low + across)}) {
      samplePatch(scene, random, origin, u, v, sigma);
      scene.corners.push_back(origin);
      scene.corners.push_back(origin + u + v);
    }
    for (const Vector3d& from :
         {low, Vector3d(low + u), Vector3d(low + v), Vector3d(low + u + v)}) {
      scene.creases.push_back({from, from + across});
    }
  }
}

}  // namespace

double Scene::creaseDistance(const VoxelIndex& v) const { return nearestOf(creases, v); }
double Scene::rimDistance(const VoxelIndex& v) const { return nearestOf(rims, v); }

double Scene::cornerDistance(const VoxelIndex& v) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vector3d& corner : corners) {
    nearest = std::min(nearest, (corner - voxelCentre(v, 1.0)).norm());
  }
  return nearest;
}

Scene planeScene(Random& random, double side, double sigma) {
  Scene scene;
  const Vector3d u = Vector3d::UnitX() * side;
  const Vector3d v = Vector3d::UnitY() * side;
  const Vector3d origin = -(u + v) / 2;
  samplePatch(scene, random, origin, u, v, sigma);
  scene.rims = {{origin, origin + u},
                {origin, origin + v},
                {origin + u, origin + u + v},
                {origin + v, origin + u + v}};
  return anyhow(random, std::move(scene));
}

Scene alignedPlaneScene(int32_t side) {
  Scene scene;
  for (int32_t z = 0; z < side; ++z) {
    for (int32_t y = 0; y < side; ++y) scene.points.push_back(voxelCentre({0, y, z}, 1.0));
  }
  const double end = side;
  const Vector3d a(0.5, 0, 0), b(0.5, end, 0), c(0.5, end, end), d(0.5, 0, end);
  scene.rims = {{a, b}, {b, c}, {c, d}, {d, a}};
  fillVoxels(scene);
  return scene;
}

Scene dihedralScene(Random& random, double angle, double length, double width) {
  Scene scene;
  const Vector3d along = Vector3d::UnitZ() * length;
  const Vector3d start = -along / 2;
  const double radians = angle * kPi / 180.0;
  const Vector3d first(width, 0, 0);
  const Vector3d second(width * std::cos(radians), width * std::sin(radians), 0);
  for (const Vector3d& face : {first, second}) {
    samplePatch(scene, random, start, along, face, 0.0);
    scene.rims.push_back({start, start + face});
    scene.rims.push_back({start + along, start + along + face});
    scene.rims.push_back({start + face, start + along + face});
  }
  scene.creases = {{start, start + along}};
  return anyhow(random, std::move(scene));
}

Scene cornerScene(Random& random, double side, double sigma) {
  Scene scene;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d u = Vector3d::Unit(axis) * side;
    const Vector3d v = Vector3d::Unit((axis + 1) % 3) * side;
    samplePatch(scene, random, Vector3d::Zero(), u, v, sigma);
    scene.creases.push_back({Vector3d::Zero(), u});
    scene.rims.push_back({u, u + v});
    scene.rims.push_back({v, u + v});
  }
  scene.corners = {Vector3d::Zero()};
  return anyhow(random, std::move(scene));
}

Scene rodScene(Random& random, double length) {
  Scene scene;
  for (double t = 0.0; t < length; t += kStep) scene.points.emplace_back(t, 0, 0);
  return anyhow(random, std::move(scene));
}

Scene ringScene(Random& random, double spacing, double radius) {
  Scene scene;
  for (double r = spacing; r <= radius; r += spacing) {
    const int steps = static_cast<int>(std::ceil(2 * kPi * r / kStep));
    for (int i = 0; i < steps; ++i) {
      const double angle = 2 * kPi * i / steps;
      scene.points.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.0);
    }
  }
  return anyhow(random, std::move(scene));
}

Scene roomScene(Random& random, const Vector3d& size, double sigma) {
  Scene scene;
  addBox(scene, random, -size / 2, size, sigma);
  addBox(scene, random, -size / 2 + Vector3d(size.x() / 4, size.y() / 4, 0), size / 3, sigma);
  return anyhow(random, std::move(scene));
}

Voxels randomCloud(Random& random, int32_t side, double density) {
  Voxels voxels;
  const int32_t low = -side / 2;
  for (int32_t z = low; z < low + side; ++z) {
    for (int32_t y = low; y < low + side; ++y) {
      for (int32_t x = low; x < low + side; ++x) {
        if (random.chance(density)) voxels.push_back({x, y, z});
      }
    }
  }
  return voxels;
}

}  // namespace edgevox::test
