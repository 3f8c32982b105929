#!/usr/bin/env bash
# Installs what is missing, builds, and passes the tests. Tests labelled "long" are left out; run
# them with: ctest --test-dir build/release -L long
set -euo pipefail

cd "$(dirname "$0")/.."
contrib/install_dependencies.sh
contrib/check_format.sh
contrib/check_floors.py
/usr/bin/python3 -m pyflakes contrib tests
contrib/build.sh Release all test-programs
if [ "$(id -u)" -eq 0 ]; then
  # As in a container; Open MPI wants to be asked twice.
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
# Tests start the programs some hundred times: without a search for fast networks for each.
export OMPI_MCA_pml=ob1
ctest --test-dir build/release --output-on-failure -LE long -j "$(nproc)"
