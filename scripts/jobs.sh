#!/bin/sh
# Parallel compile jobs: one per core, but no more than memory allows (about 1.5 GB each).
cores=$(nproc)
memory=$(awk '/MemAvailable/ {print int($2 / 1500000)}' /proc/meminfo)
[ "$memory" -lt 1 ] && memory=1
[ "$memory" -lt "$cores" ] && cores=$memory
echo "$cores"
