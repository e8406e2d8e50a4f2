// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/paper_run.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/scan/motion.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "edgevox/stage_timer.hpp"
#include "evaluation/capture.hpp"

namespace edgevox {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kOutOfTime = 3;  // exit codes of the process of a method
constexpr int kOutOfMemory = 4;
constexpr int kFailed = 5;

struct OutOfTime {};

/// Writes a record of each scan to `out` when it is done.
void followScans(const NamedPaperMethod& method, const ScanStream& scans,
                 const PaperOptions& options, std::FILE* out) {
  const std::unique_ptr<PaperMethod> aligner = method.make();
  const Disturbance disturbance = disturbedNormally(options.error.distance, options.error.angle);
  sim::Random random(options.seed);
  const double size = options.config.voxel_size;
  BitGrid<16> found;
  BitGrid<16> truth;
  double spent = 0.0;
  bool is_first = true;
  forEachPaperScan(scans, options, method.voxels, [&](const PaperScan& scan, PaperRecord record) {
    const Pose guess = disturbance.apply(scan.T_map_sensor, random);
    PaperPose pose{scan.T_map_sensor, true, {}};
    StageTimer timer(Clock::kProcessCpu);
    if (!is_first) pose = aligner->align(scan, guess);
    record.align = timer.lap();
    const Pose off = scan.T_map_sensor.inverse() * pose.T_map_sensor;
    record.located = pose.located ? 1 : 0;
    record.refusal = pose.refusal;
    record.metres = off.translation().norm();
    record.degrees = rotationAngle(off) / kDegree;
    timer.lap();
    if (aligner->isScanToScan()) {
      aligner->insert(scan, scan.T_map_sensor);
    } else if (pose.located) {
      aligner->insert(scan, pose.T_map_sensor);
    }
    record.insert = timer.lap();
    if (pose.located) addVoxels(scan.voxels, pose.T_map_sensor, size, found);
    addVoxels(scan.voxels, scan.T_map_sensor, size, truth);
    record.map_voxels = found.voxelCount();
    record.true_voxels = truth.voxelCount();
    if (!is_first) std::fwrite(&record, sizeof record, 1, out);
    std::fflush(out);
    is_first = false;
    spent += record.align + record.insert;
    if (spent > options.seconds) throw OutOfTime();
  });
}

void limitMemory(size_t megabytes) {
  rlimit limit{};
  getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur = static_cast<rlim_t>(megabytes) << 20;
  setrlimit(RLIMIT_DATA, &limit);
}

[[noreturn]] void runInProcess(const NamedPaperMethod& method, const ScanStream& scans,
                               const PaperOptions& options, int pipe) {
  limitMemory(options.megabytes);
  int code = 0;
  try {
    std::FILE* out = fdopen(pipe, "wb");
    followScans(method, scans, options, out);
    std::fclose(out);
  } catch (const OutOfTime&) {
    code = kOutOfTime;
  } catch (const std::bad_alloc&) {
    code = kOutOfMemory;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "evaluate: %s: %s\n", method.name.c_str(), error.what());
    code = kFailed;
  }
  _exit(code);
}

PaperEnd endOf(int status) {
  if (!WIFEXITED(status)) return PaperEnd::kFailed;
  switch (WEXITSTATUS(status)) {
    case 0:
      return PaperEnd::kDone;
    case kOutOfTime:
      return PaperEnd::kTime;
    case kOutOfMemory:
      return PaperEnd::kMemory;
    default:
      return PaperEnd::kFailed;
  }
}

}  // namespace

EdgeConfig publishedEdges(const Config& config) {
  EdgeConfig edges = config.edges;
  edges.mode = EdgeMode::kPaper;
  return edges;
}

void addVoxels(const VoxelScan& scan, const Pose& T_map_sensor, double voxel_size,
               BitGrid<16>& map) {
  for (const Eigen::Vector3d& centroid : placedCentroids(scan, standingAt(T_map_sensor))) {
    if (inGridRange(centroid, voxel_size)) map.set(voxelAt(centroid, 1.0 / voxel_size));
  }
}

void forEachPaperScan(const ScanStream& scans, const PaperOptions& options, PaperVoxels voxels,
                      const std::function<void(const PaperScan&, PaperRecord)>& visit) {
  Voxelizer voxelizer(options.config.voxelizer, options.config.voxel_size);
  EdgeExtractor extractor(publishedEdges(options.config), options.config.threads);
  size_t number = 0;
  size_t taken = 0;
  scans(scansToSee(options.recording), [&](const CloudView& cloud, const TruePose& truth) {
    PaperRecord record;
    record.scan = number++;
    if (!isWanted(record.scan, taken, options.recording)) return;
    ++taken;
    if (!truth) return;
    PaperScan scan;
    StageTimer timer(Clock::kProcessCpu);
    scan.scan = voxelizer.voxelize(cloud);
    record.voxelize = timer.lap();
    if (!scan.scan.too_large.empty()) {
      throw std::invalid_argument("scan " + std::to_string(record.scan) +
                                  " is not used: " + scan.scan.too_large);
    }
    const EdgeCount count = extractor.extract(scan.scan);
    record.extract = timer.lap();
    record.voxels = count.occupied;
    record.edges = count.edges;
    scan.scan = seenAtOnce(std::move(scan.scan), truth);
    scan.voxels = chosenVoxels(scan.scan, voxels);
    scan.T_map_sensor = truth(0.0);
    visit(scan, record);
  });
}

PaperRow runPaperMethod(const NamedPaperMethod& method, const ScanStream& scans,
                        const PaperOptions& options) {
  int ends[2];
  if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) {
    close(ends[0]);
    runInProcess(method, scans, options, ends[1]);
  }
  close(ends[1]);
  PaperRow row;
  row.name = method.name;
  std::FILE* in = fdopen(ends[0], "rb");
  PaperRecord record;
  while (std::fread(&record, sizeof record, 1, in) == 1) row.scans.push_back(record);
  std::fclose(in);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  row.end = endOf(status);
  row.megabytes = static_cast<double>(usage.ru_maxrss) / 1024.0;
  return row;
}

}  // namespace edgevox
