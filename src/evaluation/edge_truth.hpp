// SPDX-License-Identifier: BSD-3-Clause
// Labels against the true edges of a simulated world.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "evaluation/crease_pieces.hpp"
#include "evaluation/false_edges.hpp"
#include "evaluation/labelled_voxels.hpp"
#include "evaluation/recording.hpp"
#include "evaluation/segment_index.hpp"

namespace edgevox {

constexpr double kTruthReach = 2.0;  ///< voxels, from the centre of an edge voxel to a true edge
constexpr double kWideReach = 3.0;   ///< the same, as far as the structure tensor looks aside

/// The creases of a world, its corners and the rims of its solids among them, and which pieces of
/// them the scans have seen.
struct EdgeTruth {
  EdgeTruth() = default;
  /// The true edges of a simulated recording.
  explicit EdgeTruth(const Recording& recording);

  std::vector<Segment> creases;
  std::vector<Segment> pieces;                 ///< see CreaseSight
  std::vector<std::vector<uint32_t>> seen_by;  ///< numbers of pieces, by scan
  std::vector<uint32_t> seen;                  ///< by all scans together
};

using CauseCounts = std::array<size_t, kFalseEdgeCauses>;  ///< by FalseEdgeCause

struct TruthScore {
  size_t edges = 0;
  size_t true_edges = 0;  ///< within reach of a crease
  size_t wide_edges = 0;  ///< within the wide reach of a crease
  size_t occupied = 0;
  size_t occupied_near = 0;  ///< the same of all occupied voxels
  size_t seen = 0;           ///< pieces
  size_t covered = 0;        ///< of these, with an edge voxel within reach
  CauseCounts causes{};      ///< of a sample of the false edges

  double precision() const;      ///< NaN if there is nothing to judge, as below
  double widePrecision() const;  ///< by the wide reach
  double chance() const;         ///< precision of all occupied voxels
  double coverage() const;
  double causeShare(FalseEdgeCause cause) const;  ///< of the false edges judged
  TruthScore& operator+=(const TruthScore& more);
};

/// The truth at one voxel size.
class EdgeJudge {
 public:
  /// `truth` need not outlive this.
  EdgeJudge(const EdgeTruth& truth, double voxel_size);

  bool isTrue(const LabelledVoxel& voxel) const {
    return creases_.distanceTo(voxel.centre) <= reach_;
  }
  /// The score without causes. `seen`: numbers of the pieces to be covered.
  TruthScore score(const LabelledVoxels& voxels, const std::vector<uint32_t>& seen) const;
  /// The causes of `most` false edges, evenly taken, or of all. `T_world_grid(voxel)` is the pose
  /// of the grid at the voxel's time.
  template <typename PoseOf>
  CauseCounts causes(const LabelledVoxels& voxels, const FalseEdgeJudge& judge, size_t most,
                     const PoseOf& T_world_grid) const;

 private:
  std::vector<LabelledVoxel> falseEdges(const LabelledVoxels& voxels, size_t most) const;

  double reach_;          // [m]
  SegmentIndex creases_;  // by the wide reach
  SegmentIndex pieces_;
};

template <typename PoseOf>
CauseCounts EdgeJudge::causes(const LabelledVoxels& voxels, const FalseEdgeJudge& judge,
                              size_t most, const PoseOf& T_world_grid) const {
  BitGrid<16> occupied;
  for (const LabelledVoxel& voxel : voxels.voxels) occupied.set(voxel.index);
  CauseCounts counts{};
  for (const LabelledVoxel& edge : falseEdges(voxels, most)) {
    const auto cause = judge.causeOf(edge.index, occupied, voxels.voxel_size, T_world_grid(edge));
    ++counts[static_cast<size_t>(cause)];
  }
  return counts;
}

}  // namespace edgevox
