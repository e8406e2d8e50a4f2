// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/edges/edge_extractor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/edges/dense_kernel.hpp"
#include "core/edges/edge_kernel.hpp"
#include "core/grid/neighbourhood.hpp"
#include "core/parallel.hpp"

namespace edgevox {
namespace {

constexpr double kSparse = 0.1;  // of a plane's largest eigenvalue

kernel::Thresholds thresholdsOf(double magnitude, const EdgeThresholds& thresholds,
                                bool count_sparse) {
  const double rho = thresholds.ratio / (1.0 + thresholds.ratio);
  return {std::llround(magnitude * static_cast<double>(kernel::kPlane)),
          std::llround(std::ldexp(rho, kernel::kRatioBits)),
          std::llround(std::ldexp(thresholds.support, kernel::kSupportBits)), false,
          count_sparse ? std::llround(kSparse * static_cast<double>(kernel::kPlane)) : 0};
}

bool hasAvx2() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

kernel::LabelBlock chooseKernel(InstructionSet instruction_set, int block_edge) {
  const kernel::LabelBlock avx2 = hasAvx2() ? kernel::avx2LabelBlock(block_edge) : nullptr;
  if (instruction_set == InstructionSet::kAvx2 && avx2 == nullptr) {
    throw ConfigError(
        "edges/instruction_set is 'avx2', which this processor or build lacks; "
        "use 'auto'");
  }
  const bool portable = instruction_set == InstructionSet::kPortable || avx2 == nullptr;
  return portable ? kernel::portableLabelBlock(block_edge) : avx2;
}

/// The candidates among the `targets` of a row of a block that have enough others around them.
template <int kSide>
uint32_t surrounded(const uint64_t* candidates, int row, uint32_t targets, int neighbours) {
  const uint64_t* first = candidates + row / kSide * (kSide + 2) + row % kSide;
  uint32_t kept = 0;
  uint32_t bits = targets & static_cast<uint32_t>(first[kSide + 3] >> 1);
  for (; bits != 0; bits &= bits - 1) {
    const int x = __builtin_ctz(bits);
    uint32_t cube = 0;
    for (int i = 0; i < 9; ++i) {
      const uint64_t three = (first[i / 3 * (kSide + 2) + i % 3] >> x) & 7;
      cube |= static_cast<uint32_t>(three) << (3 * i);
    }
    if (__builtin_popcount(cube) > neighbours) kept |= 1U << x;
  }
  return kept;
}

/// Labels the voxels of one block.
template <int kSide>
class BlockLabels {
 public:
  using Grid = BitGrid<kSide>;
  using Rows = std::array<uint32_t, BlockLayout<kSide>::kRows>;

  BlockLabels(const EdgeConfig& config, const EdgeThresholds& thresholds, bool count_sparse)
      : paper_(config.mode == EdgeMode::kPaper),
        taps_(kernel::paperTaps()),
        thresholds_(thresholdsOf(config.magnitude, thresholds, count_sparse)),
        label_block_(chooseKernel(config.instruction_set, kSide)) {
    if (count_sparse) paper_thresholds_.sparse = kSparse * kernel::kPaperPlane;
  }

  /// Sets `found`; the number of targets that are sparse.
  size_t of(const Grid& occupied, const VoxelIndex& block, const typename Grid::Block& targets,
            Rows& found) const {
    Rows target;
    std::copy(targets.begin(), targets.end(), target.begin());
    if (paper_) {
      const Neighbourhood<kSide, kernel::kDenseHalo> rows(occupied, block);
      return kernel::labelBlockDense<kSide, double>(rows.data(), target.data(), found.data(), taps_,
                                                    paper_thresholds_);
    }
    const Neighbourhood<kSide, kernel::kHalo> rows(occupied, block);
    return label_block_(rows.data(), target.data(), found.data(), thresholds_);
  }

 private:
  bool paper_;
  decltype(kernel::paperTaps()) taps_;
  kernel::Thresholds thresholds_;
  kernel::DenseThresholds paper_thresholds_;
  kernel::LabelBlock label_block_;
};

/// What labelling says of a voxel with no other in reach: the same of all.
class LoneLabel {
 public:
  template <int kSide>
  explicit LoneLabel(const BlockLabels<kSide>& labels) {
    BitGrid<kSide> grid;
    grid.set({});
    typename BlockLabels<kSide>::Rows found;
    sparse_ = labels.of(grid, {}, grid.block(0), found) != 0;
    edge_ = (found[0] & 1U) != 0;
  }

  /// Sets the edges of a block whose only voxel stands alone; the number of targets that are
  /// sparse.
  template <typename Block>
  size_t set(const Block& targets, Block& edges) const {
    size_t count = 0;
    for (size_t row = 0; row < targets.size(); ++row) {
      if (targets[row] == 0) continue;
      count += sparse_ ? 1 : 0;
      const auto others = edges[row] & ~targets[row];
      edges[row] = static_cast<typename Block::value_type>(edge_ ? others | targets[row] : others);
    }
    return count;
  }

 private:
  bool edge_;
  bool sparse_;
};

/// Whether all blocks that a voxel of `block` sees within `reach` are empty but for the voxel.
template <int kSide>
bool isAlone(const BitGrid<kSide>& occupied, const VoxelIndex& block, int reach) {
  const auto* bits = occupied.findBlock(block);
  int count = 0;
  int cell = 0;
  for (size_t row = 0; row < bits->size() && count < 2; ++row) {
    if ((*bits)[row] == 0) continue;
    count += __builtin_popcount((*bits)[row]);
    cell = static_cast<int>(row) * kSide + __builtin_ctz((*bits)[row]);
  }
  if (count != 1) return false;
  const int x = cell % kSide;
  const int y = cell / kSide % kSide;
  const int z = cell / (kSide * kSide);
  const auto first = [&](int at) { return at < reach ? -1 : 0; };
  const auto last = [&](int at) { return at >= kSide - reach ? 1 : 0; };
  for (int dz = first(z); dz <= last(z); ++dz) {
    for (int dy = first(y); dy <= last(y); ++dy) {
      for (int dx = first(x); dx <= last(x); ++dx) {
        const VoxelIndex beside{block.x + dx, block.y + dy, block.z + dz};
        if (beside != block && occupied.findBlock(beside) != nullptr) return false;
      }
    }
  }
  return true;
}

}  // namespace

template <int kSide>
EdgeLabeller<kSide>::EdgeLabeller(const EdgeConfig& config, const EdgeThresholds& thresholds,
                                  int threads)
    : config_(config), thresholds_(thresholds), threads_(threads) {
  chooseKernel(config.instruction_set, kSide);
}

template <int kSide>
int EdgeLabeller<kSide>::reach() const {
  return config_.mode == EdgeMode::kPaper ? kernel::kDenseHalo : kernel::kHalo;
}

template <int kSide>
void EdgeLabeller<kSide>::label(const Grid& occupied, const Grid& targets, Grid& edges,
                                size_t* sparse) const {
  std::vector<typename Grid::Block*> edge_blocks(targets.blockCount());
  for (size_t slot = 0; slot < edge_blocks.size(); ++slot) {
    edge_blocks[slot] = &edges.editBlock(edges.insertBlock(targets.blockIndex(slot)));
  }
  std::vector<size_t> sparse_of_block(targets.blockCount());
  const BlockLabels<kSide> labels(config_, thresholds_, sparse != nullptr);
  const LoneLabel lone(labels);
  const int reach = this->reach();

  parallelFor(targets.blockCount(), threads_, [&](size_t slot) {
    const VoxelIndex& block = targets.blockIndex(slot);
    const auto& target = targets.block(slot);
    auto& edge_block = *edge_blocks[slot];
    if (isAlone(occupied, block, reach)) {
      sparse_of_block[slot] = lone.set(target, edge_block);
      return;
    }
    typename BlockLabels<kSide>::Rows found;
    sparse_of_block[slot] = labels.of(occupied, block, target, found);
    for (size_t row = 0; row < found.size(); ++row) {
      edge_block[row] = static_cast<typename Grid::Row>((edge_block[row] & ~target[row]) |
                                                        (found[row] & target[row]));
    }
  });
  if (sparse != nullptr) {
    *sparse = std::accumulate(sparse_of_block.begin(), sparse_of_block.end(), size_t{0});
  }
}

template class EdgeLabeller<8>;
template class EdgeLabeller<16>;
template class EdgeLabeller<32>;

template <int kSide>
void thinEdges(const BitGrid<kSide>& candidates, const BitGrid<kSide>& targets, int neighbours,
               BitGrid<kSide>& edges) {
  for (size_t slot = 0; slot < targets.blockCount(); ++slot) {
    const VoxelIndex& block = targets.blockIndex(slot);
    const Neighbourhood<kSide, 1> rows(candidates, block);
    const auto* before = edges.findBlock(block);
    typename BitGrid<kSide>::Block now{};
    if (before != nullptr) now = *before;
    for (int row = 0; row < BlockLayout<kSide>::kRows; ++row) {
      const auto r = static_cast<size_t>(row);
      const uint32_t kept = surrounded<kSide>(rows.data(), row, targets.block(slot)[r], neighbours);
      now[r] = static_cast<typename BitGrid<kSide>::Row>((now[r] & ~targets.block(slot)[r]) | kept);
    }
    const bool same = before != nullptr ? now == *before : BlockLayout<kSide>::isEmpty(now);
    if (!same) edges.editBlock(edges.insertBlock(block)) = now;
  }
}

template void thinEdges<8>(const BitGrid<8>&, const BitGrid<8>&, int, BitGrid<8>&);
template void thinEdges<16>(const BitGrid<16>&, const BitGrid<16>&, int, BitGrid<16>&);
template void thinEdges<32>(const BitGrid<32>&, const BitGrid<32>&, int, BitGrid<32>&);

EdgeExtractor::EdgeExtractor(const EdgeConfig& config, int threads)
    : labeller_(config, config.scan, threads) {}

EdgeCount EdgeExtractor::extract(VoxelScan& scan) {
  occupied_.clear();
  edges_.clear();
  EdgeCount count;
  for (const ScanVoxel& voxel : scan.voxels) {
    count.occupied += occupied_.set(coarser(voxel.index, 1)) ? 1 : 0;
  }
  labeller_.label(occupied_, occupied_, edges_, &count.sparse);
  setFlags(scan);
  count.edges = edges_.voxelCount();
  return count;
}

/// Voxels of a block mostly follow one another: it is looked up once.
void EdgeExtractor::setFlags(VoxelScan& scan) const {
  using Layout = BitGrid<16>::Layout;
  const BitGrid<16>::Block* edges = nullptr;
  VoxelIndex last;
  for (ScanVoxel& voxel : scan.voxels) {
    const VoxelIndex v = coarser(voxel.index, 1);
    const VoxelIndex block = Layout::block(v);
    if (edges == nullptr || block != last) edges = edges_.findBlock(block);
    last = block;
    voxel.edge = Layout::test(*edges, v);
  }
}

}  // namespace edgevox
