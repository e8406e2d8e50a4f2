// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/crease_pieces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "sim/parts.hpp"

namespace edgevox {
namespace {

using Eigen::Vector3d;

std::vector<CreasePiece> piecesOf(const sim::Solids& solids) {
  const sim::World world(solids);
  return findPieces(world, sim::findCreases(world));
}

sim::Solids turnedBox(double bend) {
  sim::Solids solids;
  sim::addTurnedBox(solids, {0, 0, 0}, {1, 1, 1}, Eigen::Quaterniond::Identity(), 0.5);
  if (bend > 0.0) {  // a ramp up to the box's upper edge at x = 0.5
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(bend, Vector3d::UnitY()));
    sim::addTurnedBox(solids, Vector3d(0.5, 0, 0.5) + turn * Vector3d(2, 0, -0.5), {4, 0.8, 1},
                      turn, 0.5);
  }
  return solids;
}

TEST(CreasePieces, AreTheEdgesOfABoxCutUp) {
  const auto pieces = piecesOf(turnedBox(0.0));
  ASSERT_EQ(pieces.size(), 12U * 4U);
  for (const CreasePiece& piece : pieces) {
    EXPECT_NEAR((piece.segment.end - piece.segment.start).norm(), 0.25, 1e-6);
    const Vector3d middle = 0.5 * (piece.segment.start + piece.segment.end);
    EXPECT_NEAR(piece.faces[0].along.dot(piece.faces[1].along), 0.0, 0.02);
    for (const CreaseFace& face : piece.faces) {
      const Vector3d point = middle + 0.3 * face.along;  // on the surface of the cube
      EXPECT_NEAR(point.cwiseAbs().maxCoeff(), 0.5, 0.01);
      EXPECT_NEAR(face.normal.dot(face.along), 0.0, 1e-9);
    }
  }
}

TEST(CreasePieces, LeaveOutObtuseBendsAndRims) {
  const auto ramp = piecesOf(turnedBox(0.5));  // 29 degrees
  for (const CreasePiece& piece : ramp) {
    const Vector3d middle = 0.5 * (piece.segment.start + piece.segment.end);
    const bool on_top_edge = std::abs(middle.x() - 0.5) < 1e-3 && std::abs(middle.z() - 0.5) < 1e-3;
    EXPECT_FALSE(on_top_edge && std::abs(middle.y()) < 0.4);
  }
  EXPECT_GT(ramp.size(), 12U);
  sim::Solids column;
  sim::addColumn(column, {}, 0.5, 2.0, 0.5);
  EXPECT_FALSE(sim::findCreases(sim::World(column)).empty());
  EXPECT_TRUE(piecesOf(column).empty());
}

/// `count` points on the top of the box beside its edge at x = 0.5, and as many on its side.
std::vector<Vector3d> pointsBeside(int on_top, int on_side) {
  std::vector<Vector3d> points;
  for (int i = 0; i < on_top; ++i) points.emplace_back(0.45 - 0.005 * i, 0.1, 0.502);
  for (int i = 0; i < on_side; ++i) points.emplace_back(0.498, 0.1, 0.45 - 0.005 * i);
  return points;
}

TEST(CreaseSight, NeedsPointsOnBothFaces) {
  const auto seen = [](int on_top, int on_side, const Vector3d& sensor) {
    CreaseSight sight(piecesOf(turnedBox(0.0)));
    return sight.addScan(pointsBeside(on_top, on_side), sensor).size();
  };
  const Vector3d near(3, 0, 3);
  EXPECT_EQ(seen(40, 0, near), 0U);
  EXPECT_EQ(seen(0, 40, near), 0U);
  EXPECT_EQ(seen(20, 19, near), 0U);
  EXPECT_EQ(seen(20, 20, near), 3U);  // the piece beside the points and its two neighbours
  EXPECT_EQ(seen(20, 20, 10.0 * near), 0U);
}

TEST(CreaseSight, AddsUpScans) {
  CreaseSight sight(piecesOf(turnedBox(0.0)));
  EXPECT_TRUE(sight.addScan(pointsBeside(12, 12), {3, 0, 3}).empty());
  EXPECT_TRUE(sight.seen().empty());
  EXPECT_TRUE(sight.addScan(pointsBeside(12, 12), {3, 0, 3}).empty());
  EXPECT_EQ(sight.seen().size(), 3U);
}

}  // namespace
}  // namespace edgevox
