#include "pipeline/memory.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>
#include <sstream>
#include <stdexcept>

#include "base/error.h"
#include "base/parallel.h"

namespace lumirank::pipeline {
namespace {

constexpr double kUnknownMemory = std::numeric_limits<double>::infinity();

// "Name: 123 kB" of a file of the proc file system, in bytes.
double proc_bytes(const char* file, const std::string& name) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(name + ":")) continue;
    std::istringstream rest(line.substr(name.size() + 1));
    if (double kilobytes = 0; rest >> kilobytes) return 1024 * kilobytes;
  }
  return kUnknownMemory;
}

// Address space that each thread takes beside what it fills: OpenBLAS maps 128 MiB (and tries for ever where
// it cannot have them), the stack is 8 MiB. Only limits of address space see it.
constexpr double kMappedPerThread = 136.0 * (1 << 20);

double limit_left(int resource, const char* used) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknownMemory;
  const double taken = proc_bytes("/proc/self/status", used);
  return std::isfinite(taken) ? static_cast<double>(limit.rlim_cur) - taken -
                                    kMappedPerThread * static_cast<double>(current_threads())
                              : kUnknownMemory;
}

double number_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  double value = 0;
  return in >> value ? value : kUnknownMemory;  // also "max"
}

// Of the process's control group and all that it lies in (version 2); pages of files can be had back.
double group_left() {
  std::ifstream in("/proc/self/cgroup");
  double left = kUnknownMemory;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("0::/")) continue;
    const std::filesystem::path root = "/sys/fs/cgroup";
    std::filesystem::path group = line.substr(4);
    while (true) {
      const auto folder = root / group;
      const double max_bytes = number_in(folder / "memory.max"), now = number_in(folder / "memory.current");
      double reclaimable = 0;
      std::ifstream statistics(folder / "memory.stat");
      std::string key;
      for (double value = 0; statistics >> key >> value;)
        if (key == "inactive_file" || key == "active_file") reclaimable += value;
      if (std::isfinite(max_bytes) && std::isfinite(now))
        left = std::min(left, max_bytes - now + reclaimable);
      if (group.empty()) break;
      group = group.parent_path();
    }
  }
  return left;
}

double machine_left() {
  const double memory = proc_bytes("/proc/meminfo", "MemAvailable"),
               swap = proc_bytes("/proc/meminfo", "SwapFree");
  return memory + (std::isfinite(swap) ? swap : 0);
}

std::string in_gigabytes(double bytes) {
  std::ostringstream text;
  text.precision(bytes < 1e10 ? 2 : 3);
  text << std::max(0.0, bytes) / 1e9 << " GB";
  return text.str();
}

}  // namespace

double available_memory() {
  return std::max(0.0, std::min({machine_left(), group_left(), limit_left(RLIMIT_AS, "VmSize"),
                                 limit_left(RLIMIT_DATA, "VmData")}));
}

// Slopes of memory.peak_bytes on a room of diffuse walls: 10^5 … 4·10^6 lights (of 86 bytes, 91 more in the
// matrix), 10^4 … 6.4·10^5 film samples with one receiver each (102 bytes, 88 more in the matrix).
double memory_of_picture(double film_samples, double lights, bool layers) {
  return (layers ? 330 : 240) * film_samples + 220 * lights;
}

void require_countable(double film_samples) {
  if (constexpr double max_samples = std::numeric_limits<std::uint32_t>::max(); film_samples > max_samples)
    throw InputError("the picture has more than 4294967295 film samples, the most that is possible",
                     "ask for a smaller --size, a lower --spp or a --crop");
}

// Two halves of three sums in double precision, and six images.
double memory_of_reference(double pixels) { return (2 * 3 * 24 + 6 * 12) * pixels; }

void require_memory(double bytes, const std::string& remedy) {
  if (const double left = available_memory(); bytes > left)
    throw InputError(
        "there is not enough memory: this takes about " + in_gigabytes(bytes) + ", and " +
            in_gigabytes(left) + " are left",
        remedy + (left < std::min(machine_left(), group_left()) ? "; or raise the limit (ulimit)" : ""));
}

void within_memory(const std::string& remedy, const std::function<void()>& work) {
  bool short_of_memory = false;
  try {
    work();
  } catch (const std::bad_alloc&) {
    short_of_memory = true;
  } catch (const std::length_error&) {  // more elements than a vector can have
    short_of_memory = true;
  }
  // Not in the handler: what the unwinding gave back is there by now.
  if (short_of_memory) throw InputError("there is not enough memory", remedy);
}

}  // namespace lumirank::pipeline
