// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "evaluation/table.hpp"
#include "evaluation/trust_matrix.hpp"

namespace edgevox {

/// A row a cell.
Table trustTable(const std::vector<TrustRecording>& recordings,
                 const std::vector<TrustCell>& cells);

/// The cells of simulated recordings summed up over their seeds, and those of bags, with what the
/// columns mean.
std::string trustMarkdown(const std::vector<TrustRecording>& recordings,
                          const std::vector<TrustCell>& cells, const TrustOptions& options);

}  // namespace edgevox
