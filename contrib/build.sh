#!/usr/bin/env bash
# Configures and builds Eunoe. Usage: contrib/build.sh [Release|Debug] [ninja target ...]
set -euo pipefail

source_folder=$(cd "$(dirname "$0")/.." && pwd)
type=${1:-Release}
shift || true
build_folder=$source_folder/build/${type,,}

mkdir -p "$build_folder"
if [ ! -f "$build_folder/build.ninja" ]; then
  cmake -G Ninja -S "$source_folder" -B "$build_folder" -DCMAKE_BUILD_TYPE="$type" \
    >"$build_folder/configure.log" 2>&1 || { cat "$build_folder/configure.log" >&2; exit 1; }
fi
ninja -C "$build_folder" "$@"
