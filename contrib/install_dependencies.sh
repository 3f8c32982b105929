#!/usr/bin/env bash
# Installs Debian packages that Eunoe needs and this machine lacks. Every dependency is
# named here, once.
# Usage: contrib/install_dependencies.sh [fuzzing] [benchmarks]
#   fuzzing     with what contrib/fuzzing/run.sh needs, too
#   benchmarks  with the programs that contrib/tools benchmark compares with, too
set -euo pipefail

build=(
  g++                          # compiler, 12 or newer
  cmake
  ninja-build
  git
  libdeal.ii-dev               # particles, meshes, parameters; brings p4est, Trilinos, Boost, Open MPI
  libboost-program-options-dev # command line
  nlohmann-json3-dev           # summary.json
  libeigen3-dev                # linear algebra of discovery
  libsqlite3-dev               # discovery's table of runs
  zlib1g-dev                   # compression of pictures
)
report=(
  python3-numpy
  python3-matplotlib
  python3-vtk9 # reader of pictures
)
checks=(
  perl             # deal.II's test driver
  clang-format     # layout of the code
  python3-pyflakes # unused and undefined names in Python
)
fuzzing=(
  clang           # compiler with libFuzzer
  libclang-rt-dev # run-time libraries of the sanitizers and of libFuzzer
)
benchmarks=(
  lammps
  liggghts
)

wanted=("${build[@]}" "${report[@]}" "${checks[@]}")
for more in "$@"; do
  case $more in
    fuzzing) wanted+=("${fuzzing[@]}") ;;
    benchmarks) wanted+=("${benchmarks[@]}") ;;
    *)
      echo "There is nothing called '$more' to install. Give 'fuzzing', 'benchmarks', both or neither." >&2
      exit 2
      ;;
  esac
done
missing=()
for package in "${wanted[@]}"; do
  if [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
    missing+=("$package")
  fi
done
if [ ${#missing[@]} -eq 0 ]; then
  exit 0
fi

echo "Installing: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "Installing packages needs root: run 'apt-get install ${missing[*]}' as root, then try again." >&2
    exit 1
  fi
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
  "${missing[@]}" >/dev/null
