#include "base/parallel.h"

#if defined(__SANITIZE_THREAD__)
#include "base/plain_threads.h"
#endif
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace lumirank {

void parallel_for(std::size_t n, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (n == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t pieces = (n + grain - 1) / grain;
  if (pieces == 1) return body(0, n);
#if defined(__SANITIZE_THREAD__)
  return plain_threads::run(pieces, [&](std::size_t k) { body(k * grain, std::min(n, (k + 1) * grain)); });
#endif
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, pieces, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t k = range.begin(); k != range.end(); ++k)
          body(k * grain, std::min(n, (k + 1) * grain));
      },
      tbb::simple_partitioner());
}

void with_threads(int threads, const std::function<void()>& work) {
#if defined(__SANITIZE_THREAD__)
  return plain_threads::with(threads, work);
#endif
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute(work);
}

int current_threads() {
#if defined(__SANITIZE_THREAD__)
  if (plain_threads::asked > 0) return plain_threads::asked;
#endif
  return tbb::this_task_arena::max_concurrency();
}

}  // namespace lumirank
