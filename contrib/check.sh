#!/usr/bin/env bash
# Installs what is missing, builds, and passes the tests. Tests labelled "long" are left out; run
# them with: ctest --test-dir build/release -L long
set -euo pipefail

cd "$(dirname "$0")/.."

# The end of the output says how long each part took.
parts=""
part() {
  local start=$SECONDS
  "${@:2}"
  parts+="$1: $((SECONDS - start)) s"$'\n'
}
trap 'printf "%s" "$parts"' EXIT

contrib/install_dependencies.sh
part "format" contrib/check_format.sh
part "floors" contrib/check_floors.py
part "names in Python" /usr/bin/python3 -m pyflakes contrib tests
part "build" contrib/build.sh Release all test-programs
if [ "$(id -u)" -eq 0 ]; then
  # Root is usual in a container; Open MPI demands both variables.
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
# No more ranks than cores: ranks that have to share a core wait for each other in every step.
part "tests" ctest --test-dir build/release --output-on-failure -LE long -j "$(nproc)"
