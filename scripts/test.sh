#!/bin/bash
# Every check, cheapest first: formatting, layers, the tests, the sanitizers, the fuzzers. Ends with ctest's summary.
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=${1:-$(nproc)}
step() { printf '\n== %s\n' "$*"; }

step "Formatting"
git ls-files '*.cpp' '*.h' | xargs clang-format --dry-run --Werror
step "Layers"
python3 cmake/check_layers.py
step "Build"
cmake --preset ci
cmake --build --preset ci -j "$jobs"
step "Fuzz targets, briefly"
cmake --preset fuzz
cmake --build --preset fuzz -j "$jobs"
scripts/fuzz.sh build/fuzz 10
step "Fast tests under the address and undefined-behaviour sanitizers"
cmake --preset asan
cmake --build --preset asan -j "$jobs" -t test_base -t test_linalg -t test_matrix -t test_scenedesc -t test_film -t test_methods
# Embree, OpenBLAS and oneTBB keep pools until exit; leaks are looked for in the readers, which use none of them.
ctest --test-dir build/asan -L 'base|linalg|matrix|scenedesc|film|methods' -j "$jobs" --output-on-failure --no-tests=error
step "Threaded tests under the thread sanitizer"
cmake --preset tsan
cmake --build --preset tsan -j "$jobs" -t test_base -t test_methods
TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp" \
  ctest --test-dir build/tsan -L 'base|methods' -j "$jobs" --output-on-failure --no-tests=error
step "Tests"
ctest --test-dir build/release -j "$jobs" --output-on-failure --no-tests=error
