// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "evaluation/paper_data.hpp"
#include "evaluation/paper_run.hpp"
#include "evaluation/table.hpp"

namespace edgevox {

/// A row a method and scan: the panels of Fig. 7.
Table paperScans(const std::vector<PaperRow>& rows);

/// A row a bin of the ratio of the eigenvalues: Fig. 4.
Table paperRatios(const PaperData& data);

/// Tables I and II, and what became of each method, with what the columns mean.
std::string paperMarkdown(const std::string& recording, const PaperData& data,
                          const std::vector<PaperRow>& rows, const PaperOptions& options);

}  // namespace edgevox
