#!/bin/sh
# Installs what Lumirank needs from Debian's or Ubuntu's own packages: `build` for the program, `test` for the tests as
# well; `denoiser` for what gets the denoiser (scripts/get-denoiser.sh).
set -eu

build="g++ make cmake ninja-build pkg-config libtbb-dev libeigen3-dev libnanoflann-dev libopenblas-dev libpugixml-dev zlib1g-dev \
libopenimageio-dev libopenexr-dev libpng-dev libjpeg-dev libcli11-dev nlohmann-json3-dev libdraco-dev libmeshoptimizer-dev libmetis-dev \
libsvm-dev libopenvdb-dev libboost-dev"
test="libgtest-dev libnanovdb-dev clang libclang-rt-dev clang-format clang-tidy python3 git"

# Embree is called libembree-dev (3 or 4) everywhere we build; another name may come with a later release.
embree=libembree-dev

case "${1:-build}" in
  build) wanted="$build $embree" ;;
  test) wanted="$build $test $embree" ;;
  denoiser) wanted="python3 python3-pip" ;;
  *) echo "usage: $0 build|test|denoiser" >&2; exit 2 ;;
esac

if ! command -v apt-get >/dev/null; then
  echo "This script knows Debian and Ubuntu. Elsewhere install the equivalents of: $wanted" >&2
  exit 1
fi

sudo=""
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "Installing packages needs root: run this as root, or install sudo." >&2; exit 1; }
  sudo=sudo
fi

missing=""
for package in $wanted; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q "ok installed" || missing="$missing $package"
done
[ -z "$missing" ] && exit 0

echo "Installing:$missing"
$sudo apt-get update -q
# shellcheck disable=SC2086
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
