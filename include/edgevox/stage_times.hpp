// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace edgevox {

/// How long the stages of the pipeline took for one scan, in their order [s]; 0 for a stage that it
/// did not come to.
struct StageTimes {
  float voxelize = 0.0F;
  float extract = 0.0F;
  float match = 0.0F;  ///< sampling, prediction, search and refinement
  float insert = 0.0F;
  float label = 0.0F;

  float total() const { return voxelize + extract + match + insert + label; }
};

struct Stage {
  const char* name;
  float StageTimes::*time;
};

constexpr std::array<Stage, 5> kStages = {{{"voxelize", &StageTimes::voxelize},
                                           {"extract", &StageTimes::extract},
                                           {"match", &StageTimes::match},
                                           {"insert", &StageTimes::insert},
                                           {"label", &StageTimes::label}}};

}  // namespace edgevox
