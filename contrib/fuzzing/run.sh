#!/usr/bin/env bash
# Builds the fuzzers with Clang and lets each look for crashes, hangs and large allocations.
# Usage: contrib/fuzzing/run.sh [seconds per target [target ...]]
# Needs the packages of `contrib/install_dependencies.sh fuzzing`. Ends with code 1 if it finds
# something; the inputs that cause it are in build/fuzzing/findings/<target>. The fuzzers' corpus
# stays in build/fuzzing/corpus and is used again.
set -euo pipefail

seconds=${1:-300}
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(parameters case gmsh table checkpoint restart restart_spreading)
source_folder=$(cd "$(dirname "$0")/../.." && pwd)
build=$source_folder/build/fuzzing
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# Short stack traces and a small quarantine, as the reader of parameters allocates much.
export ASAN_OPTIONS=detect_leaks=0:malloc_context_size=3:quarantine_size_mb=8 UBSAN_OPTIONS=print_stacktrace=1
[ -d /dev/shm ] && export TMPDIR=${TMPDIR:-/dev/shm}

"$source_folder/contrib/install_dependencies.sh" fuzzing
mkdir -p "$build"
if [ ! -f "$build/build.ninja" ]; then
  # Warnings are checked with GCC only.
  cmake -G Ninja -S "$source_folder" -B "$build" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_COMPILER=clang++ "-DEUNOE_SANITIZE=fuzzer-no-link;address;undefined" \
    -DEUNOE_FUZZERS=ON -DEUNOE_TESTS=OFF
fi
ninja -C "$build" fuzzers

# Prints the text of the head, a byte 0 and the sections: see checkpoint_image.h.
take_apart() {
  local length
  length=$(od -An -t u8 -j 19 -N 8 "$1" | tr -d ' ')
  head -c $((27 + length)) "$1" | tail -c +28 | sed 's/"input":"[^"]*"/"input":"="/'
  printf '\0'
  tail -c +$((28 + length)) "$1" | head -c -20 # a checkpoint of one chunk
}

# Runs a case until there is a checkpoint, and prints the checkpoint's path.
make_checkpoint() {
  local folder=$build/seeds/$1 case=$2 waited=0
  shift 2
  rm -rf "$folder"
  "$build/eunoe-particles" "$case" --quiet --set "simulation control/output path = $folder" \
    --set "restart/checkpoint = true" "$@" >&2 &
  while kill -0 $! 2>/dev/null && [ "$waited" -lt 1200 ] && ! ls "$folder"/*.checkpoint; do
    sleep 1
    waited=$((waited + 1))
  done >/dev/null 2>&1
  kill -9 $! 2>/dev/null || true
  wait $! 2>/dev/null || true
  if ! ls "$folder"/*.checkpoint >/dev/null 2>&1; then
    echo "$case leaves no checkpoint to begin with." >&2
    return 1
  fi
  ls "$folder"/*.checkpoint | head -1
}

fill_corpora() {
  local folder=$build/corpus file
  for target in parameters case gmsh table checkpoint restart restart_spreading; do
    mkdir -p "$folder/$target" "$build/findings/$target"
  done
  cd "$source_folder"
  cp tests/bad_input/*.prm contrib/fuzzing/seeds/restart.prm tests/restart/stirred.prm \
    tests/spreading/tiny.prm prm/examples/*.prm prm/spreading/PS1_L1.prm "$folder/parameters"
  for file in tests/restart/stirred.prm tests/spreading/tiny.prm; do
    "$build/eunoe-particles" --print-parameters "$file" |
      sed -E '/^ *#/d; /^ *$/d; s/ +# .*//' >"$folder/parameters/complete_$(basename "$file")"
  done
  cp "$folder/parameters"/* "$folder/case"
  cp tests/bad_input/*.msh "$folder/gmsh"
  cp contrib/fuzzing/seeds/*.msh "$folder/gmsh"
  cp tests/bad_input/*.csv contrib/fuzzing/seeds/*.csv "$folder/table"
  file=$(make_checkpoint general contrib/fuzzing/seeds/restart.prm)
  take_apart "$file" >"$folder/restart/general"
  cp "$file" "$folder/restart/general" "$folder/checkpoint"
  file=$(make_checkpoint spreading tests/spreading/tiny.prm --set "restart/frequency = 500")
  take_apart "$file" >"$folder/restart_spreading/spreading"
}

# The lines of the input files and the words of the other formats.
write_dictionary() {
  {
    cat contrib/fuzzing/dictionary
    sed -E 's/^ +//; s/ +#.*//; s/ +$//; s/[\\"]//g' "$build/corpus/parameters"/*.prm |
      LC_ALL=C grep -aE '^(set|subsection|end)[ -~]*$' | sort -u | sed 's/.*/"&\\x0a"/'
  } >"$build/dictionary"
}

fuzz() {
  local target=$1 program=$build/contrib/fuzzing/fuzz-${1/_spreading/} log=$build/$1.log
  [ "$target" != restart_spreading ] || export EUNOE_FUZZING_CASE=$source_folder/tests/spreading/tiny.prm
  local status=0
  "$program" "$build/corpus/$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 \
    -malloc_limit_mb=512 -dict="$build/dictionary" -artifact_prefix="$build/findings/$target/" \
    -print_final_stats=1 -verbosity=1 >"$log" 2>&1 || status=$?
  printf '%-18s %9s executions, coverage %s\n' "$target" \
    "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
    "$(grep -oE 'cov: [0-9]+ ft: [0-9]+' "$log" | tail -1)"
  if [ "$status" -ne 0 ]; then
    echo "  found something, see $log:"
    grep -m 1 -E 'ERROR|runtime error|SUMMARY' "$log" | sed 's/^/  /'
    failed=1
  fi
}

fill_corpora
write_dictionary
failed=0
for target in "${targets[@]}"; do
  fuzz "$target"
done
exit $failed
