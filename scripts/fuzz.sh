#!/bin/bash
# Runs every fuzz target of a build folder for some seconds on the corpora of the tests: fuzz.sh BUILD SECONDS
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1 seconds=$2
for target in "$build"/tests/fuzz/fuzz_*; do
  [ -x "$target" ] && [ -f "$target" ] || continue
  name=$(basename "$target")
  corpus=$(mktemp -d)
  cp tests/fuzz/corpus/"${name#fuzz_}"/* "$corpus" 2>/dev/null || true
  echo "-- $name, ${seconds} s"
  "$target" -max_total_time="$seconds" -max_len=65536 -rss_limit_mb=4096 -timeout=20 -print_final_stats=0 "$corpus" 2> "$corpus.log" || {
    tail -40 "$corpus.log"; exit 1; }
  tail -1 "$corpus.log"
  rm -rf "$corpus" "$corpus.log"
done
