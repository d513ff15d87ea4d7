#!/bin/bash
# One share of a room's tests in one process: test-shard.sh BUILD SHARDS ROOM SHARD. All its output if it fails.
set -uo pipefail
build=$1 room=$3
export GTEST_TOTAL_SHARDS=$2 GTEST_SHARD_INDEX=$4
log=$build/tests/$room.$GTEST_SHARD_INDEX.log
timeout 1500 "$build/tests/test_$room" > "$log" 2>&1 || { echo "test_$room, share $GTEST_SHARD_INDEX of $GTEST_TOTAL_SHARDS, failed with $?"; cat "$log"; exit 1; }
echo "$room $GTEST_SHARD_INDEX: $(grep -a '^\[  PASSED  \]' "$log" || echo 'no test')"
