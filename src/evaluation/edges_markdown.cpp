// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "evaluation/edge_measures.hpp"

namespace edgevox {
namespace {

using Texts = std::vector<std::string>;

std::string section(const Table& table, const std::string& title, const Texts& columns,
                    const std::string& meaning) {
  Texts all = {"voxel_m", "method"};
  all.insert(all.end(), columns.begin(), columns.end());
  const std::string text = table.markdown(all, 2);
  return text.empty() ? "" : "\n## " + title + "\n\n" + meaning + "\n\n" + text;
}

constexpr const char* kDetectors =
    "\nOther detectors: each marks as many voxels of a scan as the default with its support "
    "filter, "
    "those of the largest response to the voxels within 3 on each axis. `structure tensor`: its "
    "middle eigenvalue as published (4 voxels). `PCA of points`: least eigenvalue of the "
    "covariance "
    "of the centroids over the sum of all. `difference of Gaussians`: sigmas of 1 and 1.6 voxels "
    "on "
    "the occupancy, how far from the median of the scan. `Haar-like`: length of the vector of "
    "occupied voxels on one side less those on the other, along each axis. `Harris 3D`: that of "
    "PCL, "
    "radius 3.5 voxels.\n";

std::string head(const Recording& recording, const EdgeMeasureOptions& options) {
  std::string text = "# Edges of " + recording.name + "\n\n" +
                     std::to_string(recording.scans.size()) + " scans, poses " + recording.source +
                     ", configuration " + options.config_name;
  if (recording.without_pose > 0) {
    text += "; " + std::to_string(recording.without_pose) + " scans without a pose are left out";
  }
  return text +
         ".\n\nEdges of a scan are extracted as published (Ryde, Delmerico, Corso, eq. 5-7), or by "
         "the default without or with its support filter; `in a window`: by the occupancy of the "
         "scan and of those taken before it, so many in all (`mapper/edge_window`): " +
         std::to_string(options.config.mapper.edge_window) +
         "; the mapper's windows are of scans in sequence, as with `--every 1`. The map holds all "
         "scans, deskewed, at these poses; its occupied voxels are those hit by so many scans: " +
         std::to_string(options.config.map.min_hits) +
         ". In a simulated world floors and walls lie on the borders of its voxels, where noise "
         "spreads them over two layers; in the turned grid (25 degrees about the vertical, four "
         "tenths of a voxel aside) they do not.\n" +
         (options.detectors ? kDetectors : "");
}

constexpr const char* kCompression =
    "Voxels of a scan or of the map, and occupied voxels / kept ones: the mean of the scans' "
    "ratios, and the ratio of the sums. For an octree the occupied leaves of pcl::octree of the "
    "same leaf size are kept, on the points of each scan or on the centroids of the map's voxels "
    "(its grid is laid out from the first point, so that a surface on a border between two "
    "layers of voxels may lie within one layer of leaves); `merged`: eight occupied leaves of "
    "one parent count as one, at all levels. What the octrees of Ryde et al. (1.98, 1.75, 1.59 "
    "at 5 cm; edge voxels 2.53, 2.87, 4.47) count is not known here, so that their figures "
    "cannot be set against these.";
constexpr const char* kFalse =
    "A sample of the edge voxels that are no true ones. The surface around each, as far as it "
    "hangs together within a window of 7 x 7 x 7 voxels, is compared with the occupied voxels: "
    "what most of the missing surface is gives the cause. Rim of the view: outside the field of "
    "view or the range from every pose. Range jump: in view of some pose, but hidden. Gap: "
    "visible, but not hit (map: not by enough scans). Moved object: within 1.5 voxels of where "
    "something was for a while only, and of nothing that stands still. Other: nothing is missing.";
constexpr const char* kGhosts =
    "Occupied voxels of the map that hold what is no longer there: their centroid is within one "
    "voxel of where something was while the scans were taken, and more than 1.5 voxels from all "
    "that stands there in the end.";
constexpr const char* kTime =
    "Of the extraction alone, one thread. The map is labelled after every `map/label_every` "
    "scans.";

std::string repeatability(const EdgeMeasureOptions& options) {
  return "Of the voxels of scan i that lie in or next to an occupied voxel of scan i + " +
         std::to_string(options.pair_step) +
         ", the share in or next to an edge voxel of it: of edges, of other voxels, and the "
         "difference. The same between a scan and the map. Recall: of the map's edge voxels in or "
         "next to an occupied voxel of the scan, the share in or next to an edge voxel of it. Two "
         "windows that share scans are not compared.";
}

constexpr const char* kTruth =
    "Precision: edge voxels whose centre is within 2 voxels of a true crease, rim or corner; "
    "chance: the same of all occupied voxels. The structure tensor looks 3 voxels aside, so "
    "within 3 voxels an edge is found, if not placed, rightly. Coverage: of the straight creases "
    "that bend by 70 to 110 degrees, cut into pieces of 0.25 m, those with an edge voxel within "
    "2 voxels. Counted are pieces within 10 m of the sensor of which 20 points on each of the "
    "two faces, within 0.3 m of the piece and 3 cm of the face, were measured: by the scan "
    "itself, for the map by all scans. Edges of what moves are not true ones.";

}  // namespace

std::string edgesMarkdown(const Recording& recording, const EdgeMeasureOptions& options,
                          const Table& table) {
  return head(recording, options) +
         section(table, "Compression", {"occupied", "kept", "compression_mean", "compression_all"},
                 kCompression) +
         section(table, "Repeatability",
                 {"again_edges", "again_others", "above_chance", "map_precision", "map_chance",
                  "map_recall"},
                 repeatability(options)) +
         section(table, "Truth", {"precision", "precision_wide", "chance", "coverage"}, kTruth) +
         section(table, "False edges by cause",
                 {"false_rim", "false_jump", "false_gap", "false_moved", "false_other"}, kFalse) +
         section(table, "Ghosts", {"ghosts", "ghost_share"}, kGhosts) +
         section(table, "Time", {"ms"}, kTime);
}

}  // namespace edgevox
