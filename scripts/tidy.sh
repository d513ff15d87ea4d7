#!/bin/bash
# clang-tidy over the sources named, or over all of src and apps: tidy.sh BUILD [FILE...]. BUILD holds compile_commands.json.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1; shift
jobs=${JOBS:-$(scripts/jobs.sh)}
if [ $# -eq 0 ]; then mapfile -t files < <(git ls-files 'src/*.cpp' 'apps/*.cpp'); else files=("$@"); fi
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$jobs" clang-tidy -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option 2> >(grep -v 'warnings generated' >&2)
echo "clang-tidy: ${#files[@]} files, fine"
