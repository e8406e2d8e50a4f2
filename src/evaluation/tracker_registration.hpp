// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "edgevox/config.hpp"
#include "evaluation/capture_scene.hpp"

namespace edgevox {

/// Tracker as in a map that is localized in: the pose is set to the guess, the motion is not known,
/// and the scan is the first one. The scene must outlive what is returned.
RegistrationFor firstScanTracker(const CaptureScene& scene, const Config& config);

/// The same after the tracker has seen all probes from their true poses: a match is compared with
/// what is usual in this map.
RegistrationFor experiencedTracker(const CaptureScene& scene, const Config& config);

}  // namespace edgevox
