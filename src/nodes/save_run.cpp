// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/save_run.hpp"

#include "edgevox/io/atomic_file.hpp"
#include "run/run_files.hpp"

namespace edgevox {

std::string saveRun(const std::string& folder, const Config& config, const RunRecord& run,
                    const std::string& map_frame, bool full, Mapper& mapper) {
  if (folder.empty()) {
    throw FileError(
        "no folder to save the map to: give one in the request, or set the parameter "
        "output of the mapper");
  }
  if (folder.front() != '/') {
    throw FileError("the folder '" + folder + "' is not absolute; begin it with /");
  }
  writeRun(folder,
           {config, run, &mapper, map_frame, full ? MapContent::kFull : MapContent::kCompact});
  return "saved " + std::to_string(mapper.map().edgeVoxels().voxelCount()) + " edge voxels and " +
         std::to_string(run.located()) + " poses to " + folder;
}

}  // namespace edgevox
