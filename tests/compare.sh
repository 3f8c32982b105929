#!/bin/sh
# Compares the output of a test with what it must be, character by character. deal.II's driver would
# take numdiff, with tolerances of 1e-6 absolute or 1e-8 relative, where either suffices: smaller
# numbers are not compared at all. Tolerances belong into the tests, which know units and references.
# Usage: compare.sh -v | compare.sh [options of numdiff, which count for nothing] expected found
[ "$1" = -v ] && exit 0 # deal.II asks whether the program runs
while [ $# -gt 2 ]; do
  shift
done
exec diff "$1" "$2"
