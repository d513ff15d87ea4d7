#!/bin/bash
# Every check, cheapest first: formatting, layers, the build with warnings as errors, the fuzzers, the sanitizers, and all
# tests. The first failure ends it. The last lines are ctest's summary of the whole suite.
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=${1:-$(scripts/jobs.sh)}
step() { printf '\n== %s (after %d s)\n' "$*" "$SECONDS"; }
quiet_build() { cmake --preset "$1" > /dev/null && cmake --build --preset "$1" -j "$jobs" "${@:2}" -- --quiet; }
# sanitized PRESET ROOM...: the rooms' tests in that build; all output if one fails, else the summary.
sanitized() {
  local preset=$1 log=build/$1/tests.log; shift
  quiet_build "$preset" $(printf -- '-t test_%s ' "$@")
  local rooms; rooms=$(IFS='|'; echo "^($*)$")
  ctest --test-dir "build/$preset" -L "$rooms" -j "$jobs" --output-on-failure --no-tests=error > "$log" 2>&1 || { cat "$log"; return 1; }
  grep "tests passed" "$log"
}

step "Formatting"
if clang-format --version | grep -q 'version 14\.'; then
  git ls-files -z '*.cpp' '*.h' | xargs -0 clang-format --dry-run --Werror
else
  echo "not checked: the files follow clang-format 14 (Debian 12's), and $(clang-format --version) would change some lines"
fi
step "Layers"
python3 cmake/check_layers.py

step "Build, warnings are errors"
quiet_build ci

# Of clang-tidy only the rooms without heavy headers, to keep this short; scripts/tidy.sh build/release does all.
step "clang-tidy on the algebra"
mapfile -t algebra < <(git ls-files 'src/base/*.cpp' 'src/linalg/*.cpp' 'src/matrix/*.cpp' 'src/methods/*.cpp')
JOBS=$jobs scripts/tidy.sh build/release "${algebra[@]}"

step "Fuzz targets, briefly"
quiet_build fuzz -t fuzzers
scripts/fuzz.sh build/fuzz 10

# OpenBLAS keeps to one thread: its own threads are not instrumented.
export OPENBLAS_NUM_THREADS=1
export LSAN_OPTIONS="suppressions=$PWD/tests/lsan.supp:print_suppressions=0"
export TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp"
# Neither render nor cli: their statistical tests take minutes there, over code that the other rooms' tests reach.
step "The rooms' tests under the address and undefined-behaviour sanitizers"
sanitized asan base linalg matrix methods scenedesc film scatter emitters geometry world transport
step "Threaded tests under the thread sanitizer"
sanitized tsan base methods geometry world transport
unset OPENBLAS_NUM_THREADS

step "All tests"
ctest --test-dir build/release -j "$jobs" --output-on-failure --no-tests=error
