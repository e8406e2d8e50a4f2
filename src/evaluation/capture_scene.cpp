// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/capture_scene.hpp"

#include <stdexcept>
#include <utility>

#include "core/scan/scan_sample.hpp"

namespace edgevox {
namespace {

constexpr size_t kFewestProbes = 32;  // of a long recording

MapBuilder emptyMap(const Config& config) {
  MapConfig map = config.map;
  map.freeze_after = 0;
  return {config.voxel_size, map, config.edges, config.threads, config.voxelizer.max_range};
}

/// Keeps some of the scans added, evenly spread.
class SpreadProbes {
 public:
  void add(VoxelScan scan, const TruePose& truth) {
    const size_t number = added_++;
    if (number % step_ != 0) return;
    probes_.push_back({seenAtOnce(std::move(scan), truth), truth(0.0), number});
    if (probes_.size() == 2 * kFewestProbes) thinOut();
  }
  std::vector<CaptureProbe> take() { return std::move(probes_); }

 private:
  void thinOut() {
    for (size_t i = 1; i < kFewestProbes; ++i) probes_[i] = std::move(probes_[2 * i]);
    probes_.resize(kFewestProbes);
    step_ *= 2;
  }

  std::vector<CaptureProbe> probes_;
  size_t added_ = 0;
  size_t step_ = 1;
};

}  // namespace

CaptureScene makeScene(const std::string& name, const ScanStream& scans, size_t most,
                       const Config& config) {
  CaptureScene scene{name, emptyMap(config), {}};
  Voxelizer voxelizer(config.voxelizer, config.voxel_size);
  SpreadProbes probes;
  size_t number = 0;
  scans(most, [&](const CloudView& cloud, const TruePose& truth) {
    if (!truth) return;
    VoxelScan scan = voxelizer.voxelize(cloud);
    if (number++ % 2 == 0) {
      scene.map.insert(placedCentroids(scan, truth), truth(sweepTime(scan).middle()).translation());
    } else {
      probes.add(std::move(scan), truth);
    }
  });
  scene.map.label();
  scene.map.prepareAll();
  scene.probes = probes.take();
  if (scene.probes.empty()) {
    throw std::invalid_argument("'" + name + "' has fewer than two scans with poses");
  }
  return scene;
}

}  // namespace edgevox
