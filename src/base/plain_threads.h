// The thread sanitizer cannot see how oneTBB, which is not built with it, hands work from thread to thread,
// and takes every hand-over for a race. In that build alone, loops run on plain threads, which it does see.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace lumirank::plain_threads {

// What with_threads asked for on this thread; 0: nothing. Arenas are out of the sanitizer's sight as well.
inline thread_local int asked = 0;

inline void with(int threads, const std::function<void()>& work) {
  struct Restore {
    int before;
    ~Restore() { asked = before; }
  } restore{asked};
  asked = threads;
  work();
}

// Calls piece(0 .. pieces - 1) on four threads, however many are allowed; a loop within a loop runs on its
// caller's.
inline void run(std::size_t pieces, const std::function<void(std::size_t)>& piece) {
  thread_local bool inside = false;
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    const bool nested = inside;
    inside = true;
    try {
      for (std::size_t k; (k = next++) < pieces;) piece(k);
    } catch (...) {
      next = pieces;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
    inside = nested;
  };
  if (inside) {
    work();
  } else {
    std::vector<std::thread> threads;
    for (int t = 0; t < 3; ++t) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace lumirank::plain_threads
