#!/bin/sh
# package.sh PREFIX: the program and the library for any x86-64 machine with the libraries that Lumirank uses. Of
# the library there are three in PREFIX/lib, compiled from the same source; the loader of glibc 2.33 and later takes
# the widest that the processor has.
set -eu
if [ $# -ne 1 ]; then
  echo "usage: scripts/package.sh PREFIX" >&2
  exit 2
fi
mkdir -p "$1"
prefix=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
jobs=${JOBS:-$(scripts/jobs.sh)}

build() { # MARCH TARGET...
  march=$1
  shift
  cmake --preset release -B "build/package/$march" -DLUMIRANK_MARCH="$march" -DLUMIRANK_SHARED_PROGRAM=ON \
    -DLUMIRANK_TESTS=OFF -DCMAKE_INSTALL_LIBDIR=lib
  cmake --build "build/package/$march" -j "$jobs" --target "$@"
}

build x86-64-v2 lumirank lumirank_library
cmake --install build/package/x86-64-v2 --prefix "$prefix"
for march in x86-64-v3 x86-64-v4; do
  build "$march" lumirank_library
  mkdir -p "$prefix/lib/glibc-hwcaps/$march"
  cp "build/package/$march/liblumirank.so.0" "$prefix/lib/glibc-hwcaps/$march/liblumirank.so.0"
done
"$prefix/bin/lumirank" --version
