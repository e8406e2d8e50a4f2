// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace edgevox {

/// Calls body(i) for i in [0, count), each i once; calls must not depend on one another.
template <typename Body>
void parallelFor(size_t count, int threads, const Body& body) {
  if (threads <= 1 || count <= 1) {
    for (size_t i = 0; i < count; ++i) body(i);
    return;
  }
  tbb::task_arena arena(std::min(threads, tbb::this_task_arena::max_concurrency()));
  arena.execute([&] { tbb::parallel_for(size_t{0}, count, body); });
}

}  // namespace edgevox
