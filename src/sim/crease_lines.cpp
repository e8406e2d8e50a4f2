// SPDX-License-Identifier: BSD-3-Clause
#include "sim/crease_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

constexpr double kTouch = 1e-6;     // m, gap at which solids still count as touching
constexpr double kParallel = 1e-9;  // sine or cosine taken as zero
constexpr double kShortest = 1e-4;  // m, shorter pieces are left out

struct Segment {
  Vector3d start;
  Vector3d end;
};

// A planar face: centre, outward normal, and two half edges. Discs use their bounding square.
struct Face {
  Vector3d centre;
  Vector3d normal;
  std::array<Vector3d, 2> half;
};

std::vector<Face> facesOf(const Solid& solid) {
  std::vector<Face> faces;
  const Eigen::Matrix3d axes = solid.T_world_solid.linear() * solid.half.asDiagonal();
  for (int axis = solid.shape == Shape::Box ? 0 : 2; axis < 3; ++axis) {
    const Vector3d normal = solid.T_world_solid.linear().col(axis);
    for (const double sign : {-1.0, 1.0}) {
      faces.push_back({solid.T_world_solid.translation() + sign * axes.col(axis),
                       sign * normal,
                       {axes.col((axis + 1) % 3), axes.col((axis + 2) % 3)}});
    }
  }
  return faces;
}

void addBoxEdges(const Solid& box, std::vector<Segment>& segments) {
  const Eigen::Matrix3d axes = box.T_world_solid.linear() * box.half.asDiagonal();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double s : {-1.0, 1.0}) {
      for (const double t : {-1.0, 1.0}) {
        const Vector3d middle = box.T_world_solid.translation() + s * axes.col((axis + 1) % 3) +
                                t * axes.col((axis + 2) % 3);
        segments.push_back({middle - axes.col(axis), middle + axes.col(axis)});
      }
    }
  }
}

struct Interval {
  double from;
  double to;
};

// The part of the line origin + t direction within the face's two slabs.
std::optional<Interval> clipToFace(const Vector3d& origin, const Vector3d& direction,
                                   const Face& face, Interval interval) {
  for (const Vector3d& half : face.half) {
    const double length = half.norm();
    const double offset = (origin - face.centre).dot(half) / length;
    const double slope = direction.dot(half) / length;
    const double limit = length + kTouch;
    if (std::abs(slope) < kParallel) {
      if (std::abs(offset) > limit) return std::nullopt;
      continue;
    }
    const double a = (-limit - offset) / slope;
    const double b = (limit - offset) / slope;
    interval.from = std::max(interval.from, std::min(a, b));
    interval.to = std::min(interval.to, std::max(a, b));
  }
  if (interval.to - interval.from < kShortest) return std::nullopt;
  return interval;
}

void intersectFaces(const Face& a, const Face& b, std::vector<Segment>& segments) {
  const Vector3d cross = a.normal.cross(b.normal);
  if (cross.norm() < kParallel) return;
  const Vector3d direction = cross.normalized();
  const double cosine = a.normal.dot(b.normal);
  const double da = a.normal.dot(a.centre);
  const double db = b.normal.dot(b.centre);
  const Vector3d origin =
      ((da - db * cosine) * a.normal + (db - da * cosine) * b.normal) / (1.0 - cosine * cosine);
  auto interval = clipToFace(origin, direction, a, {-1e9, 1e9});
  if (interval) interval = clipToFace(origin, direction, b, *interval);
  if (!interval) return;
  segments.push_back({origin + interval->from * direction, origin + interval->to * direction});
}

// Lines along a cylinder where a plane parallel to its axis cuts its side.
void intersectSide(const Solid& cylinder, const Face& face, std::vector<Segment>& segments) {
  const Vector3d axis = cylinder.T_world_solid.linear().col(2);
  if (std::abs(axis.dot(face.normal)) > kParallel) return;
  const Vector3d centre = cylinder.T_world_solid.translation();
  const double distance = face.normal.dot(face.centre - centre);
  const double squared = cylinder.half[0] * cylinder.half[0] - distance * distance;
  if (squared <= 0.0) return;
  for (const double side : {-1.0, 1.0}) {
    const Vector3d middle = centre + distance * face.normal +
                            side * std::sqrt(squared) * axis.cross(face.normal).normalized();
    const auto interval = clipToFace(middle, axis, face, {-cylinder.half[2], cylinder.half[2]});
    if (interval) {
      segments.push_back({middle + interval->from * axis, middle + interval->to * axis});
    }
  }
}

void intersectSolids(const Solid& a, const Solid& b, std::vector<Segment>& segments) {
  const std::vector<Face> faces_a = facesOf(a);
  const std::vector<Face> faces_b = facesOf(b);
  for (const Face& face_a : faces_a) {
    for (const Face& face_b : faces_b) intersectFaces(face_a, face_b, segments);
    if (b.shape == Shape::Cylinder) intersectSide(b, face_a, segments);
  }
  if (a.shape != Shape::Cylinder) return;
  for (const Face& face_b : faces_b) intersectSide(a, face_b, segments);
}

// Lines closer than a millimetre in offset and a milliradian in direction share a key.
using Key = std::array<std::int64_t, 6>;

Vector3d canonicalDirection(const Segment& segment) {
  const Vector3d direction = (segment.end - segment.start).normalized();
  for (int i = 0; i < 3; ++i) {
    if (std::abs(direction[i]) > 1e-6) return direction[i] > 0.0 ? direction : -direction;
  }
  return direction;
}

Key keyOf(const Vector3d& origin, const Vector3d& direction) {
  Key key;
  for (int i = 0; i < 3; ++i) {
    key[i] = std::llround(origin[i] * 1e3 + 0.2871);  // round values stay off the borders
    key[i + 3] = std::llround(direction[i] * 1e3 + 0.2871);
  }
  return key;
}

struct Group {
  Vector3d origin;
  Vector3d direction;
  std::vector<Interval> intervals;
};

CreaseLine mergeIntervals(const Group& group) {
  CreaseLine line{group.origin, group.direction, {}, {}};
  for (const Interval& interval : group.intervals) {
    line.breaks.push_back(interval.from);
    line.breaks.push_back(interval.to);
  }
  std::sort(line.breaks.begin(), line.breaks.end());
  const auto same = [](double a, double b) { return b - a < kShortest; };
  line.breaks.erase(std::unique(line.breaks.begin(), line.breaks.end(), same), line.breaks.end());
  for (std::size_t i = 0; i + 1 < line.breaks.size(); ++i) {
    const double middle = 0.5 * (line.breaks[i] + line.breaks[i + 1]);
    line.candidate.push_back(
        std::any_of(group.intervals.begin(), group.intervals.end(),
                    [&](const Interval& part) { return part.from < middle && middle < part.to; }));
  }
  return line;
}

}  // namespace

std::vector<CreaseLine> findCreaseLines(const World& world) {
  const std::vector<Solid>& solids = world.solids();
  std::vector<Segment> segments;
  std::vector<int> near;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (solids[i].shape == Shape::Box) addBoxEdges(solids[i], segments);
    world.findSolids(solids[i].aabb().inflated(kTouch), near);
    for (const int j : near) {
      if (static_cast<std::size_t>(j) > i) intersectSolids(solids[i], solids[j], segments);
    }
  }
  std::map<Key, Group> groups;
  for (const Segment& segment : segments) {
    const Vector3d direction = canonicalDirection(segment);
    const Vector3d origin = segment.start - segment.start.dot(direction) * direction;
    Group& group =
        groups.try_emplace(keyOf(origin, direction), Group{origin, direction, {}}).first->second;
    const double a = segment.start.dot(direction);
    const double b = segment.end.dot(direction);
    group.intervals.push_back({std::min(a, b), std::max(a, b)});
  }
  std::vector<CreaseLine> lines;
  lines.reserve(groups.size());
  for (const auto& entry : groups) lines.push_back(mergeIntervals(entry.second));
  return lines;
}

std::vector<CreaseCircle> findCreaseCircles(const World& world) {
  std::vector<CreaseCircle> circles;
  std::vector<int> near;
  for (const Solid& cylinder : world.solids()) {
    if (cylinder.shape != Shape::Cylinder) continue;
    const Vector3d centre = cylinder.T_world_solid.translation();
    const Eigen::Matrix3d axes = cylinder.T_world_solid.linear();
    std::vector<double> heights = {-cylinder.half[2], cylinder.half[2]};
    world.findSolids(cylinder.aabb().inflated(kTouch), near);
    for (const int j : near) {
      for (const Face& face : facesOf(world.solids()[j])) {
        if (std::abs(std::abs(face.normal.dot(axes.col(2))) - 1.0) > kParallel) continue;
        const double height = (face.centre - centre).dot(axes.col(2));
        if (std::abs(height) < cylinder.half[2]) heights.push_back(height);
      }
    }
    std::sort(heights.begin(), heights.end());
    const auto same = [](double a, double b) { return b - a < kShortest; };
    heights.erase(std::unique(heights.begin(), heights.end(), same), heights.end());
    for (const double height : heights) {
      circles.push_back({centre + height * axes.col(2), cylinder.half[0] * axes.col(0),
                         cylinder.half[0] * axes.col(1)});
    }
  }
  return circles;
}

}  // namespace edgevox::sim
