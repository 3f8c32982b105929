#!/bin/sh
# Runs a test in the current folder and compares its output, character by character, with the
# expected output. Tolerances belong in the tests, which know units and references.
# Usage: run_test.sh expected command ...
expected=$1
shift
case $1 in
*mpiexec | *mpirun) ;;
*)
  # A program without a launcher starts faster without a daemon beside it; such programs would
  # share a folder in /tmp, so they make none. Open MPI 5 starts no daemon and does not
  # read these.
  export OMPI_MCA_ess_singleton_isolated=1 OMPI_MCA_orte_create_session_dirs=0
  ;;
esac
"$@" >output 2>&1
code=$?
if [ $code -ne 0 ]; then
  cat output
  echo "The test has ended with code $code."
  exit 1
fi
diff "$expected" output && exit 0
echo "The output differs from $expected."
exit 1
