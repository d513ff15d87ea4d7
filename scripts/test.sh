#!/bin/bash
# Every check, cheapest first: formatting, layers, the build with warnings as errors, the fuzzers, the sanitizers, and all
# tests. The first failure ends it. The last lines are ctest's summary of the whole suite.
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=${1:-$(scripts/jobs.sh)}
step() { printf '\n== %s (after %d s)\n' "$*" "$SECONDS"; }
quiet_build() { cmake --preset "$1" > /dev/null && cmake --build --preset "$1" -j "$jobs" "${@:2}" -- --quiet; }
# sanitized PRESET ROOM...: the rooms' tests in that build, each program in some processes; all output if one fails.
sanitized() {
  local preset=$1 shards=4; shift
  local -x GTEST_FILTER; GTEST_FILTER=-$(IFS=:; echo "${statistical[*]}")
  for room in "$@"; do
    for shard in $(seq 0 $((shards - 1))); do echo "$room $shard"; done
  done | xargs -P "$jobs" -L 1 scripts/test-shard.sh "build/$preset" "$shards"
}

step "Formatting"
if clang-format --version | grep -q 'version 14\.'; then
  git ls-files -z '*.cpp' '*.h' | xargs -0 clang-format --dry-run --Werror
else
  echo "not checked: the files follow clang-format 14 (Debian 12's), and $(clang-format --version) would change some lines"
fi
step "Layers"
python3 cmake/check_layers.py
step "Names in the documentation"
python3 cmake/check_docs.py

step "Build, warnings are errors"
quiet_build ci

# Over the unity build's sources, which parse what a room's files share once; scripts/tidy.sh FILE... does single files.
step "clang-tidy"
JOBS=$jobs scripts/tidy.sh build/release

# OpenBLAS keeps to one thread: its own threads are not instrumented.
export OPENBLAS_NUM_THREADS=1
# Clang 14's runtime mistakes memory that a library loaded later keeps per thread (OpenImageIO's) for another layout now and
# then, where its address happens to fit, and its search for leaks then crashes after all tests have passed; it does without such memory.
export ASAN_OPTIONS=intercept_tls_get_addr=0
export LSAN_OPTIONS="suppressions=$PWD/tests/lsan.supp:print_suppressions=0"
export TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp"
# Not the rooms from pathtrace up: their statistical tests take minutes there, over code that the tests of these reach.
# Readers of formats are what the fuzz targets run, and have neither threads nor numerics.
checked=(transport methods scatter media world linalg geometry emitters image film matrix base)
# Without those that repeat one run over many seeds to judge its statistics: they are much of the time and no new loop; all tests have them.
statistical=(Halves.OfParticlesAreIndependent 'Rules/SphericalPairs.*' Automatic.ReachesItsTargetAndSaysSo
  SamplingRecovery.TestsTellWhatPredictionsAreWorth SamplingRecovery.StepsAreWorthWhatTheyWere VirtualLights.AimingKeepsTheEnergyBalance
  VirtualLights.LightBehindAWindowIsUnbiased VirtualLights.AreAimedAtWhatReceiversSee
  VirtualLights.EmitterSamplesFollowWhatColumnsCarry 'VirtualLights.DiffuseOnlyKeepsThePlaces*'
  GatherLights.HoldTheFluxOfAClosedBox ColumnCompletion.ConvergesToAllColumns Coating.LobesFollowTheRandomWalk
  RowColumn.ErrorFallsWithColumns SamplingRecovery.ConvergesAsTheBudgetGrows StochasticLightcuts.AreUnbiased)
# Nor, under the thread sanitizer, those that go through the same loops by other settings: it takes ten times as long.
same_loops=('*EveryMethod.EveryChoiceRunsAndOneMakesADifference*' Automatic.SmallerTargetsTakeMoreColumns 'GltfBrdf.*' 'Cases/RowBoundsOfScenes.*'
  SamplingRecovery.RecoversFromFewSamples SamplingRecovery.StepsThatAreOffDoNothing VirtualLights.ALeastRoughnessWidensWhatTheyShineAndNothingElse)
step "Build with the address and undefined-behavior sanitizers"
quiet_build asan -t fuzzers $(printf -- '-t test_%s ' "${checked[@]}")
step "The rooms' tests under these sanitizers"
sanitized asan "${checked[@]}"
step "Fuzz targets, briefly"
scripts/fuzz.sh build/asan 6 "$jobs"
threaded=(transport methods world geometry base)
step "Build with the thread sanitizer"
quiet_build tsan $(printf -- '-t test_%s ' "${threaded[@]}")
step "Threaded tests under the thread sanitizer"
statistical+=("${same_loops[@]}")
sanitized tsan "${threaded[@]}"
unset OPENBLAS_NUM_THREADS

step "All tests"
ctest --test-dir build/release -j "$jobs" --output-on-failure --no-tests=error
