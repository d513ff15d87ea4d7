#!/bin/bash
# Runs every fuzz target of a build folder for some seconds on the corpora of the tests: fuzz.sh BUILD SECONDS [JOBS]
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1 seconds=$2 jobs=${3:-1}
fuzz() {
  local target=$1 seconds=$2 name corpus
  name=$(basename "$target")
  corpus=$(mktemp -d)
  cp tests/fuzz/corpus/"${name#fuzz_}"/* "$corpus" 2>/dev/null || true
  "$target" -max_total_time="$seconds" -max_len=65536 -rss_limit_mb=4096 -timeout=20 -print_final_stats=0 "$corpus" 2> "$corpus.log" || {
    tail -40 "$corpus.log"; exit 1; }
  echo "-- $name, $seconds s: $(tail -1 "$corpus.log")"
  rm -rf "$corpus" "$corpus.log"
}
export -f fuzz
find "$build/tests/fuzz" -maxdepth 1 -name 'fuzz_*' -type f -executable -print0 |
  xargs -0 -P "$jobs" -I{} bash -c 'set -eu; fuzz "$1" "$2"' fuzz {} "$seconds"
