// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace edgevox {

/// Runs the package's Python script `name` and waits for it. False if there is no such script or it
/// failed, for instance as matplotlib is missing, which it says itself on stderr.
bool runScript(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace edgevox
