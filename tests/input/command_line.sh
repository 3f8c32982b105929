#!/usr/bin/env bash
# The command line of eunoe-particles: options, exit codes, and that a run which refuses to start
# writes nothing.
# Usage: command_line.sh path/to/eunoe-particles path/to/many-runs folder path/to/prm
set -u
program=$1
cases=$(cd "$4" && pwd)
mkdir -p "$3/printed" && cd "$3" || exit 1
rm -rf results broken.prm fine.prm
failures=0

# What the program does with its words is tried in a process that is there already (many_runs.cc), which takes a
# hundredth of the time of a start.
coproc many_runs { "$2" "$PWD/printed"; }
exec 3>&"${many_runs[1]}" 4<&"${many_runs[0]}"
here() { # words of the command line
  local code
  { printf '%s' "$PWD" && printf '\t%s' "$@" && echo; } >&3
  read -r code <&4 || code=255
  cat printed/0.out printed/0.err
  return "$code"
}

expect() { # name, expected exit code, expected text, command ...
  local name=$1 code=$2 text=$3 out actual
  shift 3
  if [ "$1" = here ]; then
    out=$("$@")
  else
    out=$(timeout 60 "$@" 2>&1)
  fi
  actual=$?
  if [ "$actual" -ne "$code" ] || [[ "$out" != *"$text"* ]] || [[ "$out" == *"Stacktrace"* ]]; then
    printf '%s: exit code %s instead of %s, output:\n%s\n' "$name" "$actual" "$code" "$out"
    failures=$((failures + 1))
  fi
}

cat >fine.prm <<'PRM'
subsection simulation control
  set time step = 1e-5
  set time end = 1e-4
  set output path = results
end
subsection lagrangian physical properties
  set g = 0, 0, -9.81
end
subsection insertion info
  set insertion method = list
  set list x = 0
  set list y = 0
  set list z = 0
end
PRM
# The time step is right for the particles, but not for a wall a million times stiffer, nor for an
# impact at 20 m/s.
cat >impact.prm <<'PRM'
subsection simulation control
  set time step   = 2.1e-5
  set time end    = 4e-3
  set output path = impact
end
subsection model parameters
  set largest overlap = 0
end
subsection insertion info
  set insertion method = list
  set list x = 0
  set list y = 0
  set list z = -0.97
  set list diameters = 1e-3
  set list velocity z = -20
end
PRM
printf 'subsection mesh\n  set scael = 1\nend\n' >broken.prm

expect help 0 "Usage: eunoe-particles" "$program" --help
expect version 0 "deal.II" "$program" --version
expect "parameters" 0 "set neighborhood threshold" here --print-parameters
expect "description" 0 '"value": "a number of at least 0"' here --describe-parameters
expect "no input" 2 "An input file is missing" "$program"
expect "missing file" 2 "nowhere.prm cannot be read" here nowhere.prm
expect "unknown option" 2 "Command line:" "$program" --fast
expect "broken case" 2 "Did you mean 'scale'?" here broken.prm
expect "broken override" 2 "entry 'time stop' is unknown" \
  here fine.prm --set "simulation control/time stop = 1"
expect "override that no file can hold" 2 "a value has no '#'" \
  here fine.prm --set "simulation control/output path = run#1"
expect "check" 0 "The case is in order" here fine.prm --check
if [ -e results ]; then
  echo "a run that only checks or refuses has written something"
  failures=$((failures + 1))
fi
launch=(mpirun -np 2)
if [ "$(id -u)" -eq 0 ]; then
  launch+=(--allow-run-as-root)
fi
# As Open MPI 4 and 5 name it.
export OMPI_MCA_rmaps_base_oversubscribe=1 PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
expect "broken case on two ranks" 2 "Did you mean 'scale'?" "${launch[@]}" "$program" broken.prm
expect "run" 0 "Results are in results" "$program" fine.prm --set "subsection mesh/scale = 2"
here fine.prm >quiet_run.txt
if grep -q "Warning" quiet_run.txt; then
  echo "a run with nothing to warn of warns"
  failures=$((failures + 1))
fi
expect "hard impact" 0 "s the stiffest contact takes" here impact.prm
expect "stiff wall" 0 "the stiffest contact of particle type 0 takes" here impact.prm \
  --set "lagrangian physical properties/young modulus wall = 1e12" \
  --set "lagrangian physical properties/particle type 0/poisson ratio particles = 0.45"
expect "coarse time step" 0 "the time step exceeds 25 % of the Rayleigh time" here impact.prm \
  --set "simulation control/time step = 5e-5"
expect "values as used" 0 "= 1e-5" grep -rh "set time step" results/used.prm
expect "used.prm can be run" 0 "The case is in order" here results/used.prm --check
here "$cases/spreading/quickstart.prm" --print-parameters >all.prm
expect "parameters of a process as input" 0 "The case is in order" here all.prm --check
here fine.prm --seed 2 --print-parameters >option.prm
here fine.prm --set "simulation control/seed = 2" --print-parameters >entry.prm
expect "--seed is the entry" 0 "" cmp option.prm entry.prm
expect "it turns the others" 0 "5" grep -c "prn seed *= 2\|set seed *= 2" option.prm
expect "no seed" 2 "Give a whole number" here fine.prm --check --seed two
expect "run on two ranks" 0 "Results are in results" "${launch[@]}" "$program" fine.prm
touch file
expect "unwritable folder" 2 "cannot be written to" \
  here fine.prm --set "simulation control/output path = file/results"
exit $failures
