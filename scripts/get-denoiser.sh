#!/bin/sh
# Gets Open Image Denoise, with which Lumirank denoises pictures: its shared libraries for processors, from the Python package
# pyoidn, which carries them, into the user's data folder, where Lumirank looks for them. Nothing is built or installed elsewhere.
set -eu
version=2.5.1.0
hash=sha256:32ad13368f8de1ef63001942ad05b02a00cd732d1206d97f352d3a3f606d823e

fail() { echo "$*" >&2; exit 1; }

[ "$(uname -s)-$(uname -m)" = Linux-x86_64 ] || fail "The package has Open Image Denoise for Linux on x86-64 only, and this is $(uname -s) \
on $(uname -m). Install version 2 of it from elsewhere, where the system finds libraries or where LUMIRANK_DENOISER says."

# Relative folders do not count, here as in Lumirank.
case "${XDG_DATA_HOME:-}" in
  /*) data=$XDG_DATA_HOME ;;
  *) data=${HOME:?is not set, so there is no folder for data}/.local/share ;;
esac
folder=$data/lumirank/denoiser
stamp=$folder/FROM.txt
if [ -e "$folder" ]; then
  [ -f "$stamp" ] || fail "$folder is there and not from this script: remove it first."
  if grep -q "$hash" "$stamp"; then echo "Open Image Denoise is in $folder already."; exit 0; fi
fi

cd "$(dirname "$0")/.."
python3 -m pip --version > /dev/null 2>&1 || scripts/install-dependencies.sh denoiser

mkdir -p "$data/lumirank"
# Beside its place, so that renaming makes it appear whole.
work=$(mktemp -d "$folder.XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM

echo "pyoidn==$version --hash=$hash" > "$work/wanted.txt"
python3 -m pip download --quiet --disable-pip-version-check --no-cache-dir --no-deps --only-binary :all: --require-hashes \
  -r "$work/wanted.txt" -d "$work"

# What reaches graphics cards is most of the package and stays there. Libraries find each other in ../lib, hence its name.
mkdir -p "$work/new/lib"
python3 - "$work"/pyoidn-*.whl "$work/new" <<'EOF'
import pathlib, sys, zipfile
wheel, new = zipfile.ZipFile(sys.argv[1]), pathlib.Path(sys.argv[2])
starts = ("libOpenImageDenoise.so.2", "libOpenImageDenoise_core.so.2.5.1", "libOpenImageDenoise_device_cpu.so.2.5.1", "libtbb.so.12")
for start in starts:
    file = new / "lib" / start
    file.write_bytes(wheel.read(f"pyoidn/oidn/lib/{start}"))
    file.chmod(0o755)
(new / "LICENSE-pyoidn").write_bytes(wheel.read("pyoidn-2.5.1.0.dist-info/licenses/LICENSE"))
EOF
# The package brings the license of its own Python files alone; that of both libraries is the one of Lumirank.
cp LICENSE "$work/new/LICENSE-Apache-2.0"
cat > "$work/new/FROM.txt" <<EOF
Intel Open Image Denoise 2.5.1 and oneTBB (both Apache License 2.0), unchanged, from the Python package pyoidn $version
$hash
EOF
chmod 755 "$work/new"

[ ! -e "$folder" ] || mv "$folder" "$work/old"
mv -T "$work/new" "$folder"
echo "Open Image Denoise is in $folder."
