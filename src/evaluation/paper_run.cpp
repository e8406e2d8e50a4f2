// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/paper_run.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <system_error>

#include "edgevox/edges/edge_extractor.hpp"
#include "edgevox/grid/block_grid.hpp"
#include "edgevox/scan/motion.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "evaluation/capture.hpp"

namespace edgevox {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kOutOfTime = 3;  // exit codes of the process of a method
constexpr int kOutOfMemory = 4;
constexpr int kFailed = 5;

/// CPU time of this thread.
double secondsNow() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <typename Work>
double secondsOf(const Work& work) {
  const double start = secondsNow();
  work();
  return secondsNow() - start;
}

/// A map as published: the union of the voxels of all scans.
class UnionMap {
 public:
  explicit UnionMap(double voxel_size) : inverse_size_(1.0 / voxel_size) {}

  void add(const VoxelScan& scan, const Pose& T_map_sensor) {
    for (const ScanVoxel& voxel : scan.voxels) {
      const Eigen::Vector3d centroid = T_map_sensor * voxel.centroid.cast<double>();
      if (inGridRange(centroid, 1.0 / inverse_size_)) voxels_.set(voxelAt(centroid, inverse_size_));
    }
  }
  size_t count() const { return voxels_.voxelCount(); }

 private:
  double inverse_size_;
  BitGrid<16> voxels_;
};

struct OutOfTime {};

/// Writes a record of each scan to `out` when it is done.
void followScans(const NamedPaperMethod& method, const ScanStream& scans,
                 const PaperOptions& options, std::FILE* out) {
  const std::unique_ptr<PaperMethod> aligner = method.make();
  const Disturbance disturbance = disturbedNormally(options.distance, options.angle);
  sim::Random random(options.seed);
  UnionMap found(options.config.voxel_size);
  UnionMap truth(options.config.voxel_size);
  double spent = 0.0;
  bool is_first = true;
  forEachPaperScan(scans, options, [&](const PaperScan& scan, PaperRecord record) {
    const Pose guess = disturbance.apply(scan.T_map_sensor, random);
    PaperPose pose{scan.T_map_sensor, true};
    if (!is_first) record.align = secondsOf([&] { pose = aligner->align(scan, guess); });
    const Pose off = scan.T_map_sensor.inverse() * pose.T_map_sensor;
    record.located = pose.located ? 1 : 0;
    record.metres = off.translation().norm();
    record.degrees = rotationAngle(off) / kDegree;
    const Pose& at = aligner->isScanToScan() ? scan.T_map_sensor : pose.T_map_sensor;
    if (pose.located || aligner->isScanToScan()) {
      record.insert = secondsOf([&] { aligner->insert(scan, at); });
    }
    const VoxelScan voxels = chosenVoxels(scan, method.voxels);
    if (pose.located) found.add(voxels, pose.T_map_sensor);
    truth.add(voxels, scan.T_map_sensor);
    record.map_voxels = found.count();
    record.true_voxels = truth.count();
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

void forEachPaperScan(const ScanStream& scans, const PaperOptions& options,
                      const std::function<void(const PaperScan&, PaperRecord)>& visit) {
  EdgeConfig edges = options.config.edges;
  edges.mode = EdgeMode::kPaper;
  Voxelizer voxelizer(options.config.voxelizer, options.config.voxel_size);
  EdgeExtractor extractor(edges, options.config.threads);
  size_t number = 0;
  scans(options.most * options.every, [&](const CloudView& cloud, const TruePose& truth) {
    PaperRecord record;
    record.scan = number++;
    if (record.scan % options.every != 0 || !truth) return;
    PaperScan scan;
    record.voxelize = secondsOf([&] { scan.scan = voxelizer.voxelize(cloud); });
    record.extract = secondsOf([&] {
      const EdgeCount count = extractor.extract(scan.scan);
      record.voxels = count.occupied;
      record.edges = count.edges;
    });
    scan.scan = seenAtOnce(std::move(scan.scan), truth);
    scan.voxels = inMapVoxels(scan.scan);
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
