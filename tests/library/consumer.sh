#!/bin/bash
# The library as a stranger has it: installed into a folder, found by CMake and by pkg-config, used by the
# example programs, which are run. consumer.sh BUILD SOURCE
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/installed" > "$work/install.log"
cp -r "$source/examples/library" "$work/examples"  # nothing of the source tree may be found by accident
cmake -S "$work/examples" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/installed" -DCMAKE_BUILD_TYPE=Debug > "$work/configure.log"
cmake --build "$work/build" -j 2 > "$work/build.log" || { cat "$work/build.log"; exit 1; }
run() { echo "== $*"; "$work/build/$1" "${@:2}"; }
run render_file "$source/examples/box.xml" "$work/box.png"
run scene_in_memory "$work/memory.exr"
run methods_on_one_matrix
run own_estimate "$work/own.exr"
run relight "$work/relit.exr"
run compare_methods "$work/comparison"
run render_shot "$source/examples/moving-box.xml" "$work/shot"
test -s "$work/comparison/index.html" -a -s "$work/shot/frame_0005.png"
for picture in box.png memory.exr own.exr relit.exr; do test -s "$work/$picture"; done
# pkg-config and a compiler alone.
export PKG_CONFIG_PATH=$(dirname "$(find "$work/installed" -name lumirank.pc)")
flags=$(pkg-config --cflags --libs lumirank --define-variable=prefix="$work/installed")
${CXX:-c++} "$work/examples/scene_in_memory.cpp" $flags -o "$work/by_hand"
LD_LIBRARY_PATH=$(dirname "$(find "$work/installed" -name 'liblumirank.so' | head -1)") "$work/by_hand" "$work/by_hand.exr"
# Only what public headers declare is shown.
symbols=$(nm -DC --defined-only "$(find "$work/installed" -name 'liblumirank.so')" | grep -E ' [TBDR] ' | grep -E 'lumirank::(pipeline|transport|methods|world|scatter|image|scenedesc)::' || true)
test -z "$symbols" || { echo "shown without being public:"; echo "$symbols" | head; exit 1; }
"$work/installed/bin/lumirank" --version
