// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/capture_report.hpp"

#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "edgevox/io/number_text.hpp"
#include "edgevox/statistics.hpp"
#include "evaluation/pcl_registration.hpp"
#include "evaluation/share.hpp"
#include "evaluation/tracker_registration.hpp"

namespace edgevox {
namespace {

struct NamedRegistration {
  const char* name;
  RegistrationFor make;
};

std::vector<Disturbance> disturbances() {
  return {disturbedNormally(0.5, 10.0), disturbedWithin(1.0, 20.0), disturbedWithin(2.0, 45.0)};
}

std::vector<NamedRegistration> registrations(const CaptureScene& scene, const Config& config) {
  return {{"edgevox (first scan)", firstScanTracker(scene, config)},
          {"edgevox", experiencedTracker(scene, config)},
          {"PCL GICP", pclGicp(scene, config)},
          {"PCL NDT", pclNdt(scene, config)}};
}

/// By disturbance, summed up over the probes.
std::vector<CaptureCounts> captureAll(const CaptureScene& scene, const RegistrationFor& make,
                                      const std::vector<Disturbance>& disturbed,
                                      const CaptureOptions& options) {
  const size_t trials = (options.trials + scene.probes.size() - 1) / scene.probes.size();
  std::vector<std::vector<CaptureCounts>> of_probes(scene.probes.size());
  parallelFor(scene.probes.size(), options.threads, [&](size_t i) {
    const Registration registration = make(scene.probes[i]);
    for (const Disturbance& disturbance : disturbed) {
      of_probes[i].push_back(capture(scene.probes[i], disturbance, trials, registration));
    }
  });
  std::vector<CaptureCounts> sums(disturbed.size());
  for (const auto& counts : of_probes) {
    for (size_t d = 0; d < sums.size(); ++d) sums[d] += counts[d];
  }
  return sums;
}

}  // namespace

void CaptureTable::add(const CaptureScene& scene,
                       const std::function<void(const std::string&)>& note) {
  const std::vector<Disturbance> disturbed = disturbances();
  const std::vector<NamedRegistration> methods = registrations(scene, options_.config);
  std::vector<std::vector<CaptureCounts>> counts;
  for (const NamedRegistration& method : methods) {
    note("capture in " + scene.name + " by " + method.name);
    counts.push_back(captureAll(scene, method.make, disturbed, options_));
  }
  for (size_t d = 0; d < disturbed.size(); ++d) {
    for (size_t m = 0; m < methods.size(); ++m) {
      addRow(scene, disturbed[d], methods[m].name, counts[m][d]);
    }
  }
}

void CaptureTable::addRow(const CaptureScene& scene, const Disturbance& disturbance,
                          const char* registration, const CaptureCounts& counts) {
  table_.addRow();
  table_.set("recording", scene.name);
  table_.set("disturbance", disturbance.name);
  table_.set("registration", registration);
  table_.set("trials", static_cast<double>(counts.trials()));
  table_.set("right", 1e2 * shareOf(counts.right, counts.trials()));
  table_.set("refused", 1e2 * shareOf(counts.refused, counts.trials()));
  table_.set("wrong", 1e2 * shareOf(counts.wrong, counts.trials()));
  table_.set("ms", quantile(counts.milliseconds, 0.5));
}

std::string CaptureTable::markdown() const {
  return "# Poses found from a wrong guess\n\nConfiguration " + options_.config_name + ".\n\n" +
         table_.markdown({"recording", "disturbance", "registration", "trials", "right", "refused",
                          "wrong", "ms"},
                         3) +
         "\nThe map is of the scans with even numbers, at their true poses; probes are scans with "
         "odd numbers, spread over the recording. Map and probes are deskewed by the true motion. "
         "The guesses are the same for all rows of a disturbance: sigma is that of a normal "
         "distribution on each of the three axes, of translation and rotation alike; within: in "
         "any direction, by a length and an angle that are evenly distributed up to the limit.\n\n"
         "Right: accepted and within " +
         shortText(kFoundDistance) + " m and " + shortText(kFoundAngle) +
         " degree of the truth, as in `evaluate map`; refused: not accepted; the rest is accepted "
         "and wrong. ms: CPU time of a trial.\n\n"
         "edgevox: the tracker of the mapper, its pose set to the guess, its motion not known, "
         "with its restarts and its fallback to all voxels. It is the tracker that accepts: also "
         "a pose that is found, but farther from the guess than it allows (2 m, 60 degrees), is "
         "refused. The one of the first scan has no history, as when it begins to localize: half "
         "of the scan "
         "in occupied voxels is enough. The other one has tracked all probes from their true poses "
         "before, and asks for its usual share, as while mapping.\n\n"
         "PCL: centroids of the scan's voxels to those of the map's voxels in range, which are "
         "prepared outside of the time. GICP with correspondences up to " +
         shortText(kGicpCorrespondence) + " m, NDT with cells of " + shortText(kNdtResolution) +
         " m, 50 steps at most; a pose is refused if they say that they have not converged. GICP "
         "and NDT take it for converged, too, when they have made all their steps.\n";
}

}  // namespace edgevox
