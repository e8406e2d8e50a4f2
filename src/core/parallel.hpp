// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace edgevox {

/// A point that one thread passes before another. ThreadSanitizer cannot see those of TBB's
/// library, which is not built for it.
class OrderedPoint {
 public:
#ifdef __SANITIZE_THREAD__
  void passed() { __tsan_release(this); }
  void follow() { __tsan_acquire(this); }
#else
  void passed() {}
  void follow() {}
#endif
};

/// Calls body(i) for i in [0, count), each i once; calls must not depend on one another.
template <typename Body>
void parallelFor(size_t count, int threads, const Body& body) {
  if (threads <= 1 || count <= 1) {
    for (size_t i = 0; i < count; ++i) body(i);
    return;
  }
  tbb::task_arena arena(std::min(threads, tbb::this_task_arena::max_concurrency()));
  OrderedPoint start, end;
  start.passed();
  arena.execute([&] {
    tbb::parallel_for(size_t{0}, count, [&](size_t i) {
      start.follow();
      body(i);
      end.passed();
    });
  });
  end.follow();
}

}  // namespace edgevox
