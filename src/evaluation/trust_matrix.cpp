// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/trust_matrix.hpp"

#include <mutex>
#include <optional>

#include "core/parallel.hpp"
#include "edgevox/mapping/mapper.hpp"

namespace edgevox {
namespace {

/// The mapper of one cell.
class StrideRun {
 public:
  StrideRun(size_t stride, const Config& config) : stride_(stride), mapper_(config) {}

  void process(size_t number, const VoxelScan& scan, const TruePose& truth) {
    if (number % stride_ != 0) return;
    tally_.add(mapper_.process(scan), truth ? std::optional<Pose>(truth(0.0)) : std::nullopt);
  }
  const TrustCounts& counts() const { return tally_.counts(); }

 private:
  size_t stride_;
  Mapper mapper_;
  TrustTally tally_;
};

/// The cells of one recording, by stride.
std::vector<TrustCounts> runStrides(const ScanStream& scans, const TrustOptions& options) {
  Voxelizer voxelizer(options.config.voxelizer, options.config.voxel_size);
  std::vector<StrideRun> runs;
  for (const size_t stride : options.strides) runs.emplace_back(stride, options.config);
  size_t number = 0;
  scans(options.most, [&](const CloudView& cloud, const TruePose& truth) {
    const VoxelScan scan = voxelizer.voxelize(cloud);
    for (StrideRun& run : runs) run.process(number, scan, truth);
    ++number;
  });
  std::vector<TrustCounts> counts;
  for (const StrideRun& run : runs) counts.push_back(run.counts());
  return counts;
}

}  // namespace

std::vector<TrustCell> runMatrix(const std::vector<TrustRecording>& recordings,
                                 const TrustOptions& options,
                                 const std::function<void(const std::string&)>& note) {
  std::vector<std::vector<TrustCounts>> counts(recordings.size());
  std::mutex noting;
  size_t done = 0;
  parallelFor(recordings.size(), options.threads, [&](size_t i) {
    counts[i] = runStrides(recordings[i].scans, options);
    const std::lock_guard<std::mutex> lock(noting);
    note(recordings[i].name + ", " + std::to_string(++done) + " of " +
         std::to_string(recordings.size()));
  });
  std::vector<TrustCell> cells;
  for (size_t i = 0; i < recordings.size(); ++i) {
    for (size_t s = 0; s < options.strides.size(); ++s) {
      cells.push_back({i, options.strides[s], counts[i][s]});
    }
  }
  return cells;
}

}  // namespace edgevox
