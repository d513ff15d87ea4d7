#!/bin/sh
# Renders the example interior, for at most 15 seconds, and says where the picture is.
set -eu
cd "$(dirname "$0")/.."
mkdir -p out
build/release/lumirank render examples/interior.xml --time 15 -o out/demo.png -o out/demo.exr --tonemap agx --report out/demo.json
echo
echo "The picture: $(pwd)/out/demo.png   (linear: out/demo.exr, what it cost: out/demo.json)"
