// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/matching/global_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/matching/branch_and_bound.hpp"
#include "core/matching/one_answer.hpp"
#include "core/matching/shift_pyramid.hpp"
#include "core/parallel.hpp"
#include "edgevox/scan/motion.hpp"

namespace edgevox {
namespace {

constexpr double kRadians = M_PI / 180.0;         // in a degree
constexpr int kHeight = 5;                        // of the pyramid
constexpr size_t kMostBytes = size_t{64} << 20;   // of it
constexpr double kLargestTurn = 10.0 * kRadians;  // of the grid of rotations [rad]
constexpr double kShare = 0.85;                   // of the hits of the best candidate
constexpr double kLeastShare = 0.8;               // of the evidence that is asked for in the end
constexpr size_t kMostCandidates = 24;            // refined
constexpr double kNear = 4.0;                     // of a better candidate [cell]
constexpr double kNearSteps = 3.0;                // the same [step of the grid]
constexpr double kOfMisfit = 0.35;                // of what does not fit, as a margin
constexpr double kLongestMove = 8.0;              // of a refinement [cell]
constexpr double kNearDistance = 3.0;             // of a given pose, along each axis [m]
constexpr double kNearTurn = 60.0 * kRadians;     // the same

/// Rotations of the sensor in the map in steps of `turn` [rad].
std::vector<Eigen::Matrix3d> rotationsIn(const SearchRegion& region, double turn) {
  std::vector<Eigen::Matrix3d> rotations;
  const auto steps = [&](double angle) {
    return static_cast<int>(std::max(1.0, std::ceil(angle / turn)));
  };
  const Eigen::Matrix3d level =
      region.around ? region.around->T_map_sensor.linear() : region.R_level_sensor;
  const double whole = region.around ? std::min(2 * region.around->turn, 2 * M_PI) : 2 * M_PI;
  const int yaws = whole < 2 * M_PI ? steps(whole) + 1 : steps(whole);
  const double yaw_step = whole < 2 * M_PI ? whole / std::max(1, yaws - 1) : whole / yaws;
  const double tilt = std::clamp(region.tilt, 0.0, M_PI);
  const int rings = static_cast<int>(std::ceil(tilt / turn - 1e-9));
  for (int ring = 0; ring <= rings; ++ring) {
    const double angle = rings == 0 ? 0.0 : tilt * ring / rings;
    const int ways = steps(2 * M_PI * std::sin(angle));
    for (int way = 0; way < ways; ++way) {
      const double towards = 2 * M_PI * way / ways;
      const Eigen::Vector3d axis(std::cos(towards), std::sin(towards), 0.0);
      const Eigen::Matrix3d tilted = rotationOf(angle * axis) * level;
      for (int yaw = 0; yaw < yaws; ++yaw) {
        rotations.emplace_back(rotationOf({0.0, 0.0, yaw_step * yaw - whole / 2}) * tilted);
      }
    }
  }
  return rotations;
}

}  // namespace

const char* toString(SearchOutcome outcome) {
  switch (outcome) {
    case SearchOutcome::kFound:
      return "found";
    case SearchOutcome::kAmbiguous:
      return "ambiguous";
    case SearchOutcome::kNotFound:
      return "not found";
    case SearchOutcome::kCancelled:
      return "cancelled";
  }
  return "";
}

SearchRegion::Around SearchRegion::near(const Pose& T_map_sensor) {
  return {T_map_sensor, kNearDistance, kNearTurn};
}

/// Of a place that has changed, more must speak for the best pose.
double leastAlike(double best, const SearchConfig& config) {
  return best - std::max(config.margin, kOfMisfit * (1.0 - best));
}

/// The finest level whose pyramid is not too large.
GlobalSearch::GlobalSearch(const MatchMap& map, const Config& config)
    : map_(map), matcher_(config.matcher), config_(config.search) {
  int level = 1;
  while (level + 1 < map_.levels() &&
         ShiftPyramid::bytes(boxOf(map_.occupied(level)), kHeight) > kMostBytes) {
    ++level;
  }
  cell_ = map_.voxelSize(level) / 2;
  pyramid_ = std::make_unique<ShiftPyramid>(map_.occupied(level), kHeight);
}

GlobalSearch::GlobalSearch(GlobalSearch&&) noexcept = default;
GlobalSearch& GlobalSearch::operator=(GlobalSearch&&) noexcept = default;
GlobalSearch::~GlobalSearch() = default;

size_t GlobalSearch::bytes() const { return pyramid_->bytes(); }

std::vector<Candidate> GlobalSearch::candidates(const ScanSample& sample,
                                                const SearchRegion& region, double share, int least,
                                                size_t most, const SearchControl& control) const {
  std::vector<Candidate> candidates;
  const VoxelBox& box = pyramid_->box();
  if (sample.empty() || box.empty()) return candidates;
  const double range = std::max(medianRange(sample, sample.size()), 2 * cell_);
  const double turn = std::min(2 * cell_ / range, kLargestTurn);
  const std::vector<Eigen::Matrix3d> rotations = rotationsIn(region, turn);
  std::vector<std::vector<VoxelIndex>> points(rotations.size());
  for (size_t r = 0; r < rotations.size(); ++r) {
    for (const Eigen::Vector3d& point : sample) {
      points[r].push_back(voxelAt(rotations[r] * point, 1.0 / cell_));
    }
  }
  VoxelBox shifts = box;
  if (region.around) {
    const Eigen::Vector3d centre = region.around->T_map_sensor.translation();
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(region.around->distance);
    shifts =
        common(box, {voxelAt(centre - reach, 1.0 / cell_), voxelAt(centre + reach, 1.0 / cell_)});
  }
  BranchAndBound search(*pyramid_, points, share, least, control);
  for (const SearchNode& leaf : search.find(shifts)) {
    Candidate candidate;
    candidate.T_map_sensor.linear() = rotations[leaf.rotation];
    candidate.T_map_sensor.translation() =
        cell_ * Eigen::Vector3d(leaf.shift.x, leaf.shift.y, leaf.shift.z);
    candidate.hits = leaf.bound;
    const bool known = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
      return areNear(c.T_map_sensor, candidate.T_map_sensor, kNear * cell_, kNearSteps * turn);
    });
    if (known) continue;
    candidates.push_back(candidate);
    if (candidates.size() == most) break;
  }
  return candidates;
}

SearchResult GlobalSearch::search(const ScanSample& sample, const SearchRegion& region,
                                  const SearchControl& control) const {
  if (control.percent != nullptr) *control.percent = 0;
  const auto points = std::min(sample.size(), static_cast<size_t>(config_.points));
  const ScanSample few(sample.begin(), sample.begin() + static_cast<ptrdiff_t>(points));
  const double least = kLeastShare * config_.min_evidence * static_cast<double>(points);
  const std::vector<Candidate> found =
      candidates(few, region, kShare, static_cast<int>(std::ceil(least)), kMostCandidates, control);
  std::vector<MatchResult> matches(found.size());
  parallelFor(found.size(), control.threads, [&](size_t i) {
    if (control.isCancelled()) return;
    MatchRequest request;
    request.guess.T_map_sensor = found[i].T_map_sensor;
    request.max_translation = kLongestMove * cell_;
    request.trusted_hit_ratio = 1.0;
    matches[i] = matcher_.align(map_, sample, request);
  });
  std::stable_sort(matches.begin(), matches.end(), [](const MatchResult& a, const MatchResult& b) {
    return evidenceOf(a) > evidenceOf(b);
  });
  SearchResult result;
  for (const MatchResult& match : matches) {
    const bool known =
        std::any_of(result.answers.begin(), result.answers.end(), [&](const MatchResult& answer) {
          return areOneAnswer(answer.T_map_sensor, match.T_map_sensor);
        });
    if (!known && match.refusal == Refusal::kNone) result.answers.push_back(match);
  }
  if (control.isCancelled()) {
    result.outcome = SearchOutcome::kCancelled;
    result.answers.clear();
  }
  if (result.answers.empty() || evidenceOf(result.answers.front()) < config_.min_evidence) {
    return result;
  }
  const double alike = leastAlike(evidenceOf(result.answers.front()), config_);
  const auto lesser =
      std::find_if(result.answers.begin(), result.answers.end(),
                   [&](const MatchResult& answer) { return evidenceOf(answer) < alike; });
  if (lesser - result.answers.begin() > 1) {
    result.outcome = SearchOutcome::kAmbiguous;
    result.answers.erase(lesser, result.answers.end());
  } else {
    result.outcome = SearchOutcome::kFound;
  }
  return result;
}

}  // namespace edgevox
