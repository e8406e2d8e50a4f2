// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/paper_report.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>

#include "edgevox/io/number_text.hpp"
#include "edgevox/statistics.hpp"
#include "evaluation/capture.hpp"
#include "evaluation/share.hpp"

namespace edgevox {
namespace {

using Value = std::function<double(const PaperRecord&)>;

std::vector<double> valuesOf(const std::vector<PaperRecord>& scans, const Value& value) {
  std::vector<double> values;
  for (const PaperRecord& scan : scans) values.push_back(value(scan));
  return values;
}

double sumOf(const std::vector<PaperRecord>& scans, const Value& value) {
  const std::vector<double> values = valuesOf(scans, value);
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double quantileOf(const std::vector<PaperRecord>& scans, double share, const Value& value) {
  return quantile(valuesOf(scans, value), share);
}

bool isRight(const PaperRecord& scan) {
  return scan.located != 0 && scan.metres < kFoundDistance && scan.degrees < kFoundAngle;
}

std::string endText(const PaperRow& row, const PaperOptions& options) {
  switch (row.end) {
    case PaperEnd::kDone:
      return "";
    case PaperEnd::kTime:
      return "more than " + shortText(options.seconds) + " s";
    case PaperEnd::kMemory:
      return "more than " + std::to_string(options.megabytes) + " MB";
    case PaperEnd::kFailed:
      return "failed";
  }
  return "";
}

const char* wordsFor(Refusal refusal) {
  switch (refusal) {
    case Refusal::kTooFar:
      return "far from the guess";
    case Refusal::kFewHits:
      return "few points fit";
    case Refusal::kDisagrees:
      return "disagrees";
    case Refusal::kBlocked:
      return "through walls";
    case Refusal::kAmbiguous:
      return "ambiguous";
    default:
      return "other";
  }
}

/// Of the lost scans, as "few points fit 3; through walls 1".
std::string lostText(const std::vector<PaperRecord>& scans) {
  std::map<std::string, size_t> counts;
  for (const PaperRecord& scan : scans) {
    if (scan.located == 0 && scan.refusal != Refusal::kNone) ++counts[wordsFor(scan.refusal)];
  }
  std::string text;
  for (const auto& [words, count] : counts) {
    text += (text.empty() ? "" : "; ") + words + " " + std::to_string(count);
  }
  return text;
}

Table summaryOf(const std::vector<PaperRow>& rows, const PaperOptions& options) {
  Table table({{"method", "method"},
               {"scans", "scans", 0},
               {"right", "right %", 1},
               {"lost", "lost", 0},
               {"why", "why"},
               {"cm", "position median [cm]", 1},
               {"cm90", "90 % [cm]", 1},
               {"degrees", "rotation median [degrees]", 2},
               {"degrees90", "90 % [degrees]", 2},
               {"align", "align [ms]", 1},
               {"total_align", "align, all [s]", 1},
               {"total_insert", "insert, all [s]", 1},
               {"map", "map / true map", 2},
               {"megabytes", "peak memory [MB]", 0},
               {"end", "exceeds"}});
  for (const PaperRow& row : rows) {
    std::vector<PaperRecord> located;
    std::copy_if(row.scans.begin(), row.scans.end(), std::back_inserter(located),
                 [](const PaperRecord& scan) { return scan.located != 0; });
    table.addRow();
    table.set("method", row.name);
    table.set("scans", static_cast<double>(row.scans.size()));
    const auto right =
        static_cast<size_t>(std::count_if(row.scans.begin(), row.scans.end(), isRight));
    table.set("right", 1e2 * shareOf(right, row.scans.size()));
    table.set("lost", static_cast<double>(row.scans.size() - located.size()));
    table.set("why", lostText(row.scans));
    const Value cm = [](const PaperRecord& scan) { return 1e2 * scan.metres; };
    const Value degrees = [](const PaperRecord& scan) { return scan.degrees; };
    table.set("cm", quantileOf(located, 0.5, cm));
    table.set("cm90", quantileOf(located, 0.9, cm));
    table.set("degrees", quantileOf(located, 0.5, degrees));
    table.set("degrees90", quantileOf(located, 0.9, degrees));
    const Value align = [](const PaperRecord& scan) { return scan.align; };
    table.set("align", 1e3 * quantileOf(row.scans, 0.5, align));
    table.set("total_align", sumOf(row.scans, align));
    table.set("total_insert", sumOf(row.scans, [](const PaperRecord& s) { return s.insert; }));
    if (!row.scans.empty()) {
      const PaperRecord& last = row.scans.back();
      table.set("map", shareOf(last.map_voxels, last.true_voxels));
    }
    table.set("megabytes", row.megabytes);
    table.set("end", endText(row, options));
  }
  return table;
}

std::string count(double value) { return fixedText(value, 0); }

std::string dataText(const std::string& recording, const PaperData& data,
                     const PaperOptions& options) {
  return "## Table I: the data\n\n"
         "| recording | scans | points a scan | voxels a scan | voxel [m] | extent [m] |\n"
         "|---|---|---|---|---|---|\n| " +
         recording + " | " + std::to_string(data.scans) + " | " + count(data.points) + " | " +
         count(data.voxels) + " | " + shortText(options.config.voxel_size) + " | " +
         count(data.extent.x()) + " x " + count(data.extent.y()) + " x " + count(data.extent.z()) +
         " |\n";
}

std::string times(double all, double some) {
  return some > 0 ? fixedText(all / some, 2) : std::string("-");
}

std::string compressionText(const PaperData& data) {
  const auto row = [](const std::string& name, const std::string& voxels, const std::string& edges,
                      const std::string& ratio, const std::string& leaves,
                      const std::string& octree) {
    return "| " + name + " | " + voxels + " | " + edges + " | " + ratio + " | " + leaves + " | " +
           octree + " |\n";
  };
  const auto map_voxels = static_cast<double>(data.map_voxels);
  return "\n## Table II: compression\n\n"
         "| of | voxels | edge voxels | voxels / edges | octree leaves, merged | voxels / leaves "
         "|\n"
         "|---|---|---|---|---|---|\n" +
         row("a scan, mean", count(data.voxels), count(data.edges), fixedText(data.compression, 2),
             count(data.merged_leaves), times(data.voxels, data.merged_leaves)) +
         row("the map, the union of all scans", std::to_string(data.map_voxels),
             std::to_string(data.map_edges), times(map_voxels, static_cast<double>(data.map_edges)),
             std::to_string(data.map_merged_leaves),
             times(map_voxels, static_cast<double>(data.map_merged_leaves)));
}

std::string extractionText(const PaperData& data) {
  std::string text =
      "\n## Extraction by threads\n\n| threads | largest scan [ms] | speed-up |\n|---|---|---|\n";
  for (const ExtractionTime& time : data.extraction) {
    text += "| " + std::to_string(time.threads) + " | " + fixedText(time.milliseconds, 1) + " | " +
            times(data.extraction.front().milliseconds, time.milliseconds) + " |\n";
  }
  return text;
}

}  // namespace

Table paperScans(const std::vector<PaperRow>& rows) {
  Table table({{"method", ""},
               {"scan", "", 0},
               {"voxels", "", 0},
               {"edges", "", 0},
               {"located", "", 0},
               {"metres", ""},
               {"degrees", ""},
               {"voxelize_ms", ""},
               {"extract_ms", ""},
               {"align_ms", ""},
               {"insert_ms", ""},
               {"map_voxels", "", 0},
               {"true_voxels", "", 0}});
  for (const PaperRow& row : rows) {
    for (const PaperRecord& scan : row.scans) {
      table.addRow();
      table.set("method", row.name);
      table.set("scan", static_cast<double>(scan.scan));
      table.set("voxels", static_cast<double>(scan.voxels));
      table.set("edges", static_cast<double>(scan.edges));
      table.set("located", static_cast<double>(scan.located));
      table.set("metres", scan.metres);
      table.set("degrees", scan.degrees);
      table.set("voxelize_ms", 1e3 * scan.voxelize);
      table.set("extract_ms", 1e3 * scan.extract);
      table.set("align_ms", 1e3 * scan.align);
      table.set("insert_ms", 1e3 * scan.insert);
      table.set("map_voxels", static_cast<double>(scan.map_voxels));
      table.set("true_voxels", static_cast<double>(scan.true_voxels));
    }
  }
  return table;
}

Table paperRatios(const PaperData& data) {
  Table table({{"from", ""}, {"to", ""}, {"voxels", "", 0}});
  for (size_t bin = 0; bin < PaperData::kBins; ++bin) {
    table.addRow();
    table.set("from", static_cast<double>(bin) / PaperData::kBins);
    table.set("to", static_cast<double>(bin + 1) / PaperData::kBins);
    table.set("voxels", static_cast<double>(data.ratios[bin]));
  }
  return table;
}

std::string paperMarkdown(const std::string& recording, const PaperData& data,
                          const std::vector<PaperRow>& rows, const PaperOptions& options) {
  return "# Edge voxel maps as published\n\n"
         "Ryde, Delmerico, Corso, Generating Edge Voxel Maps with Structure Tensor Analysis. "
         "Configuration of edgevox: " +
         options.config_name + ", voxels of " + shortText(options.config.voxel_size) +
         " m for all.\n\n" + dataText(recording, data, options) + compressionText(data) +
         extractionText(data) + "\n## Fig. 7: the methods\n\n" +
         summaryOf(rows, options)
             .markdown(
                 {"method", "scans", "right", "lost", "why", "cm", "cm90", "degrees", "degrees90",
                  "align", "total_align", "total_insert", "map", "megabytes", "end"},
                 1) +
         "\nEach scan is aligned from its true pose, moved by a normal error of " +
         shortText(options.error.distance) + " m and " + shortText(options.error.angle) +
         " degrees on each axis, the same for all methods (seed " + std::to_string(options.seed) +
         "). Scans are deskewed by the true motion. Right: within " + shortText(kFoundDistance) +
         " m and " + shortText(kFoundAngle) +
         " degree. The quantiles are of the located scans; align: CPU time of a scan, median.\n\n"
         "ICP: of PCL, from scan to scan, the last scan at its true pose; correspondences up to " +
         shortText(kIcpCorrespondence) + " m, " + std::to_string(kIcpSteps) +
         " steps at most. MROL: hill climbing of all voxels of the scan in the voxel lists of the "
         "map, as published, each scan inserted where it was found. edgevox: its matcher, "
         "which is told these deviations, by all voxels of the scan; a lost one is not "
         "inserted.\n\n"
         "Map / true map: voxels of the union of the scans at the poses found, and at the true "
         "ones; a smeared map has more. Peak memory: of a process that runs the method alone. "
         "Extraction as published; least of several wall times.\n";
}

}  // namespace edgevox
