// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace edgevox::sim {

// Diffuse reflectivities, 0 to 1.
constexpr double kPlaster = 0.8;
constexpr double kConcrete = 0.5;
constexpr double kBrick = 0.4;
constexpr double kWood = 0.6;
constexpr double kMetal = 0.3;
constexpr double kCloth = 0.35;
constexpr double kAsphalt = 0.15;
constexpr double kLeaves = 0.55;
constexpr double kPaint = 0.7;

}  // namespace edgevox::sim
