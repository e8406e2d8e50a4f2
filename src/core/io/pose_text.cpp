// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/io/pose_text.hpp"

#include <array>
#include <cmath>
#include <locale>
#include <sstream>

namespace edgevox {

std::optional<Pose> poseOfText(const std::string& text) {
  std::array<double, 4> values{};
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  char comma = ',';
  for (size_t i = 0; i < values.size(); ++i) {
    if ((i > 0 && !(stream >> comma)) || comma != ',' || !(stream >> values[i])) {
      return std::nullopt;
    }
  }
  if (!(stream >> std::ws).eof()) return std::nullopt;
  const double yaw = values[3] * M_PI / 180.0;
  return Eigen::Translation3d(values[0], values[1], values[2]) *
         Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
}

}  // namespace edgevox
