// SPDX-License-Identifier: BSD-3-Clause
// Registrations of PCL, to compare with: centroids of a scan to those of the voxels of a map that
// are hit, in range of the scan's true pose. The scene must outlive what is returned; the target is
// prepared when a probe is chosen, outside of the trials.
#pragma once

#include "edgevox/config.hpp"
#include "evaluation/capture_scene.hpp"

namespace edgevox {

constexpr double kGicpCorrespondence = 2.0;  ///< largest distance of two points that correspond [m]
constexpr double kNdtResolution = 1.0;       ///< of the target's cells [m]

RegistrationFor pclGicp(const CaptureScene& scene, const Config& config);
RegistrationFor pclNdt(const CaptureScene& scene, const Config& config);

}  // namespace edgevox
