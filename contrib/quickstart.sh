#!/usr/bin/env bash
# Installs what is missing, builds Eunoe, spreads five layers of powder and writes a report: one
# file that any browser shows.
set -euo pipefail

cd "$(dirname "$0")/.."
# Open MPI counts cores, not their threads.
cores=$(lscpu -p=SOCKET,CORE | grep -v '^#' | sort -u | wc -l)
ranks=$((cores < $(nproc) ? cores : $(nproc)))
if [ "$ranks" -gt 4 ]; then
  ranks=4 # a case of three thousand particles gains nothing from more
fi
ranks=${EUNOE_RANKS:-$ranks}

contrib/install_dependencies.sh
echo "Building (a few minutes the first time)"
contrib/build.sh Release eunoe-particles eunoe-discovery
launch=(mpirun -np "$ranks")
if [ "$(id -u)" -eq 0 ]; then
  launch+=(--allow-run-as-root)
fi
"${launch[@]}" build/release/eunoe-particles prm/spreading/quickstart.prm
contrib/tools report output/quickstart
