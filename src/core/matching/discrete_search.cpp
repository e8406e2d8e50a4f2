// SPDX-License-Identifier: BSD-3-Clause
#include "core/matching/discrete_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/matching/one_answer.hpp"
#include "edgevox/scan/motion.hpp"

namespace edgevox {
namespace {

constexpr double kQuarterDegree = 0.25 * M_PI / 180.0;  // [rad]
constexpr int kCoarsestPublished = 5;                   // level
constexpr double kDrawnDistance = 2.0;                  // of the last drawn, on each axis [m]
constexpr double kDrawnAngle = 50.0 * M_PI / 180.0;     // the same [rad]
constexpr int kDrawn = 2000;                            // poses
constexpr size_t kDrawnPoints = 100;                    // of the sample, by which they are compared
constexpr double kDrawnVoxel = 1.6;                     // at most, by which they are compared [m]
constexpr double kNearDistance = 0.25;                  // of a better start [voxel]
constexpr double kNearAngle = 5.0 * M_PI / 180.0;       // the same [rad]

/// Steepest ascent over `moves` until none gains; ties go to the earlier move.
template <typename Score>
Pose climb(const std::vector<Move>& moves, Pose pose, int& best, const Score& scoreOf) {
  for (;;) {
    const Move* chosen = nullptr;
    for (const Move& move : moves) {
      const int s = scoreOf(apply(pose, move));
      if (s <= best) continue;
      best = s;
      chosen = &move;
    }
    if (chosen == nullptr) return pose;
    pose = apply(pose, *chosen);
  }
}

std::vector<Move> axisMoves(double step, double angle) {
  std::vector<Move> moves;
  for (int axis = 0; axis < 6; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Move move = Move::Zero();
      move[axis] = sign * (axis < 3 ? step : angle);
      moves.push_back(move);
    }
  }
  return moves;
}

/// One translation and one rotation at once.
std::vector<Move> coupledMoves(double step, double angle) {
  std::vector<Move> moves;
  for (int t = 0; t < 3; ++t) {
    for (int r = 3; r < 6; ++r) {
      for (const double st : {1.0, -1.0}) {
        for (const double sr : {1.0, -1.0}) {
          Move move = Move::Zero();
          move[t] = st * step;
          move[r] = sr * angle;
          moves.push_back(move);
        }
      }
    }
  }
  return moves;
}

/// Uniform in [-1, 1), the same on every machine.
double signedUniform(uint64_t& state) {
  state += 0x9e3779b97f4a7c15ULL;
  return std::ldexp(static_cast<double>(mixBits(state) >> 11), -52) - 1.0;
}

Pose disturbed(const Pose& guess, double scale, uint64_t& state) {
  Move move;
  for (int i = 0; i < 6; ++i) {
    move[i] = scale * signedUniform(state) * (i < 3 ? kDrawnDistance : kDrawnAngle);
  }
  return apply(guess, move);
}

int coarsestLevelWithin(const MatchMap& map, double voxel_size) {
  int level = map.levels() - 1;
  while (level > DiscreteSearch::kFinestLevel && map.voxelSize(level) > voxel_size) --level;
  return level;
}

}  // namespace

Pose apply(const Pose& pose, const Move& move) {
  Pose out = pose;
  out.translation() += move.head<3>();
  out.linear() = rotationOf(move.tail<3>()) * pose.linear();
  return out;
}

DiscreteSearch::DiscreteSearch(const MatchMap& map, const ScanSample& sample, size_t points)
    : map_(map), sample_(sample), points_(std::min(points, sample.size())) {}

int DiscreteSearch::hits(int level, const Pose& T_map_sensor) {
  look_ups_ += points_;
  return level == 0 ? hitsIn(map_.hitVoxels(), level, T_map_sensor)
                    : hitsIn(map_.occupied(level), level, T_map_sensor);
}

template <typename Bits>
int DiscreteSearch::hitsIn(const Bits& occupied, int level, const Pose& T_map_sensor) const {
  const double inverse_size = 1.0 / map_.voxelSize(level);
  const Eigen::Matrix3d rotation = T_map_sensor.linear() * inverse_size;
  const Eigen::Vector3d translation = T_map_sensor.translation() * inverse_size;
  int hits = 0;
  for (size_t i = 0; i < points_; ++i) {
    const Eigen::Vector3d p = rotation * sample_[i] + translation;
    hits += occupied.test(voxelAt(p, 1.0)) ? 1 : 0;
  }
  return hits;
}

Pose DiscreteSearch::climb(const Pose& start, int coarsest) {
  if (points_ == 0) return start;
  const double range = std::max(medianRange(sample_, points_), map_.voxelSize(1));
  Pose pose = start;
  for (int level = coarsest; level >= kFinestLevel; --level) {
    const auto hitsOf = [&](const Pose& p) { return hits(level, p); };
    const double size = map_.voxelSize(level);
    int best = hitsOf(pose);
    for (const double step : {size, size / 2}) {
      pose = edgevox::climb(axisMoves(step, step / range), pose, best, hitsOf);
    }
  }
  return pose;
}

Pose DiscreteSearch::climbAsPublished(const Pose& start) {
  Pose pose = start;
  const auto pass = [&](int level, double step, double angle) {
    auto moves = axisMoves(step, angle);
    const auto coupled = coupledMoves(step, angle);
    moves.insert(moves.end(), coupled.begin(), coupled.end());
    const auto hitsOf = [&](const Pose& p) { return hits(level, p); };
    int best = hitsOf(pose);
    pose = edgevox::climb(moves, pose, best, hitsOf);
  };
  for (int level = std::min(map_.levels() - 1, kCoarsestPublished); level >= 0; --level) {
    pass(level, map_.voxelSize(level), kQuarterDegree * (1 << level));
  }
  pass(0, map_.voxelSize(0) / 4, kQuarterDegree / 4);
  renormalise(pose);
  return pose;
}

RestartPoses restartPoses(const MatchMap& map, const ScanSample& sample, const Pose& guess,
                          double reach, uint64_t seed, size_t most) {
  struct Drawn {
    Pose T_map_sensor;
    int hits = 0;
  };
  RestartPoses starts;
  const int level = coarsestLevelWithin(map, kDrawnVoxel);
  starts.level = std::min(level + 1, map.levels() - 1);
  DiscreteSearch search(map, sample, kDrawnPoints);
  uint64_t state = mixBits(seed + 1);
  std::vector<Drawn> drawn(kDrawn);
  for (size_t i = 0; i < drawn.size(); ++i) {
    const double growth = static_cast<double>(i + 1) / kDrawn;
    drawn[i].T_map_sensor = disturbed(guess, reach * growth, state);
    drawn[i].hits = search.hits(level, drawn[i].T_map_sensor);
  }
  starts.look_ups = search.lookUps();
  std::stable_sort(drawn.begin(), drawn.end(),
                   [](const Drawn& a, const Drawn& b) { return a.hits > b.hits; });
  const double near_distance = kNearDistance * map.voxelSize(level);
  for (const Drawn& pose : drawn) {
    if (starts.best.size() == most) break;
    const bool known = std::any_of(starts.best.begin(), starts.best.end(), [&](const Pose& better) {
      return areNear(pose.T_map_sensor, better, near_distance, kNearAngle);
    });
    if (!known) starts.best.push_back(pose.T_map_sensor);
  }
  return starts;
}

}  // namespace edgevox
