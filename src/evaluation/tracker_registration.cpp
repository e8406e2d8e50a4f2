// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/tracker_registration.hpp"

#include "edgevox/tracking/tracker.hpp"

namespace edgevox {
namespace {

ScanResult trackFrom(const Pose& guess, const VoxelScan& scan, const MatchMap& map, uint32_t seed,
                     Tracker& tracker) {
  tracker.setPose(guess);
  return tracker.track(scan, {}, {map, false, seed});
}

RegistrationFor trackerFrom(const CaptureScene& scene, const Tracker& start) {
  return [&scene, start](const CaptureProbe& probe) -> Registration {
    return [&scene, &probe, start](const Pose& guess, uint64_t seed) -> CapturedPose {
      Tracker tracker = start;
      const ScanResult result =
          trackFrom(guess, probe.scan, scene.map.matchMap(), static_cast<uint32_t>(seed), tracker);
      return {result.T_map_sensor, result.located()};
    };
  };
}

}  // namespace

RegistrationFor firstScanTracker(const CaptureScene& scene, const Config& config) {
  return trackerFrom(scene, Tracker(config));
}

RegistrationFor experiencedTracker(const CaptureScene& scene, const Config& config) {
  Tracker tracker(config);
  for (const CaptureProbe& probe : scene.probes) {
    trackFrom(probe.T_map_sensor, probe.scan, scene.map.matchMap(), 0, tracker);
  }
  return trackerFrom(scene, tracker);
}

}  // namespace edgevox
