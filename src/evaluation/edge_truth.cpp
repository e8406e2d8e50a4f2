// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/edge_truth.hpp"

#include <cmath>
#include <numeric>

#include "evaluation/share.hpp"

namespace edgevox {
EdgeTruth::EdgeTruth(const Recording& recording) {
  const sim::World& world = recording.truth->world;
  const std::vector<sim::Crease> found = sim::findCreases(world);
  for (const sim::Crease& crease : found) creases.push_back({crease.start, crease.end});
  CreaseSight sight(findPieces(world, found));
  pieces = sight.segments();
  for (size_t i = 0; i < recording.scans.size(); ++i) {
    seen_by.push_back(
        sight.addScan(pointsInWorld(recording, i), recording.scans[i].T_map_sensor.translation()));
  }
  seen = sight.seen();
}

double TruthScore::precision() const { return shareOf(true_edges, edges); }
double TruthScore::widePrecision() const { return shareOf(wide_edges, edges); }
double TruthScore::chance() const { return shareOf(occupied_near, occupied); }
double TruthScore::coverage() const { return shareOf(covered, seen); }

double TruthScore::causeShare(FalseEdgeCause cause) const {
  return shareOf(causes[static_cast<size_t>(cause)],
                 std::accumulate(causes.begin(), causes.end(), size_t{0}));
}

TruthScore& TruthScore::operator+=(const TruthScore& more) {
  edges += more.edges;
  true_edges += more.true_edges;
  wide_edges += more.wide_edges;
  occupied += more.occupied;
  occupied_near += more.occupied_near;
  seen += more.seen;
  covered += more.covered;
  for (size_t i = 0; i < causes.size(); ++i) causes[i] += more.causes[i];
  return *this;
}

EdgeJudge::EdgeJudge(const EdgeTruth& truth, double voxel_size)
    : reach_(kTruthReach * voxel_size),
      creases_(truth.creases, kWideReach * voxel_size),
      pieces_(truth.pieces, kTruthReach * voxel_size) {}

TruthScore EdgeJudge::score(const LabelledVoxels& voxels, const std::vector<uint32_t>& seen) const {
  TruthScore score;
  std::vector<bool> covered(pieces_.segments().size(), false);
  for (const LabelledVoxel& voxel : voxels.voxels) {
    const double distance = creases_.distanceTo(voxel.centre);
    const bool near = distance <= reach_;
    ++score.occupied;
    score.occupied_near += near ? 1 : 0;
    if (!voxel.edge) continue;
    ++score.edges;
    score.true_edges += near ? 1 : 0;
    score.wide_edges += std::isfinite(distance) ? 1 : 0;
    pieces_.forEachNear(voxel.centre, [&](uint32_t piece) { covered[piece] = true; });
  }
  score.seen = seen.size();
  for (const uint32_t piece : seen) score.covered += covered[piece] ? 1 : 0;
  return score;
}

std::vector<LabelledVoxel> EdgeJudge::falseEdges(const LabelledVoxels& voxels, size_t most) const {
  std::vector<LabelledVoxel> all;
  for (const LabelledVoxel& voxel : voxels.voxels) {
    if (voxel.edge && !isTrue(voxel)) all.push_back(voxel);
  }
  if (all.size() <= most) return all;
  std::vector<LabelledVoxel> sample;
  for (size_t i = 0; i < most; ++i) sample.push_back(all[i * all.size() / most]);
  return sample;
}

}  // namespace edgevox
