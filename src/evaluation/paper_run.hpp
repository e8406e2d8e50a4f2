// SPDX-License-Identifier: BSD-3-Clause
// The protocol of Ryde, Delmerico, Corso 2013: scans in their order, each aligned from a guess that
// is wrong by a random error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/grid/block_grid.hpp"
#include "evaluation/paper_method.hpp"
#include "evaluation/recording.hpp"
#include "evaluation/scan_stream.hpp"

namespace edgevox {

struct PaperOptions {
  RecordingOptions recording;  ///< which scans are used
  uint64_t seed = 1;           ///< of the errors of the guesses, the same for all methods
  GuessError error;
  double seconds = 600.0;                    ///< of CPU time that a method may take for all scans
  size_t megabytes = 8192;                   ///< that a method may have in memory
  Config config;                             ///< of edgevox; its voxel size is that of all methods
  std::string config_name = "the defaults";  ///< to print
};

/// What became of one scan. In bytes from process to process.
struct PaperRecord {
  uint64_t scan = 0;  ///< number in the recording
  uint64_t voxels = 0;
  uint64_t edges = 0;
  uint64_t located = 0;
  Refusal refusal = Refusal::kNone;  ///< why it is not
  double metres = 0.0;               ///< of the pose from the truth
  double degrees = 0.0;              ///< the same
  double voxelize = 0.0;             ///< CPU time, as the next three [s]
  double extract = 0.0;
  double align = 0.0;
  double insert = 0.0;
  uint64_t map_voxels = 0;   ///< after this scan, of the map built by the poses found
  uint64_t true_voxels = 0;  ///< the same by the true poses
};

enum class PaperEnd { kDone, kTime, kMemory, kFailed };

struct PaperRow {
  std::string name;
  std::vector<PaperRecord> scans;  ///< without the first one, which is where it truly was
  PaperEnd end = PaperEnd::kDone;  ///< why there are no more scans
  double megabytes = 0.0;          ///< of peak memory of a process that does nothing else
};

/// The extractor as published.
EdgeConfig publishedEdges(const Config& config);

/// Adds the voxels in which a scan at this pose lies to a map, the union of all scans.
void addVoxels(const VoxelScan& scan, const Pose& T_map_sensor, double voxel_size,
               BitGrid<16>& map);

/// Goes through the scans of a recording that have a true pose, with their edges as published.
void forEachPaperScan(const ScanStream& scans, const PaperOptions& options, PaperVoxels voxels,
                      const std::function<void(const PaperScan&, PaperRecord)>& visit);

/// Runs a method in a process of its own, with the limits of `options`.
PaperRow runPaperMethod(const NamedPaperMethod& method, const ScanStream& scans,
                        const PaperOptions& options);

}  // namespace edgevox
