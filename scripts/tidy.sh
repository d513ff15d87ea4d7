#!/bin/bash
# clang-tidy: tidy.sh BUILD [FILE...]. BUILD holds compile_commands.json. Without files: everything that BUILD compiles of src
# and apps; in a unity build that is its merged sources, and the findings still name the files that they are in.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1; shift
jobs=${JOBS:-$(scripts/jobs.sh)}
checks=()
if [ $# -eq 0 ]; then
  checks=(--checks=-bugprone-suspicious-include)  # merged sources consist of such
  mapfile -t files < <(python3 - "$build/compile_commands.json" <<'EOF'
import json, os, sys
build = os.path.dirname(sys.argv[1])
for entry in json.load(open(sys.argv[1])):
    name = os.path.relpath(os.path.join(entry["directory"], entry["file"]))
    inner = os.path.relpath(name, build)
    if (name if inner.startswith("..") else inner).startswith(("src/", "apps/")):
        print(name)
EOF
)
else files=("$@"); fi
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$jobs" clang-tidy -p "$build" --quiet ${checks[@]+"${checks[@]}"} --extra-arg=-Wno-unknown-warning-option 2> >(grep -v 'warnings generated' >&2)
echo "clang-tidy: ${#files[@]} files, fine"
