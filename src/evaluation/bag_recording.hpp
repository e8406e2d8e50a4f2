// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation/recording.hpp"

namespace edgevox {

/// The clouds of a bag; those that cannot be read are left out. Throws BagError, FileError,
/// TrajectoryError.
Recording readBagRecording(const RecordingOptions& options);

}  // namespace edgevox
