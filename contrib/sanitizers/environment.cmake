# Settings of the sanitizers for all tests; ctest reads this file before it runs them.

# No search for leaks: Open MPI keeps memory of modules that it has unloaded by then, which cannot
# be told from a leak of Eunoe. contrib/tools soak watches the memory instead.
set(ENV{ASAN_OPTIONS} "detect_leaks=0:detect_stack_use_after_return=1:strict_string_checks=1")
set(ENV{UBSAN_OPTIONS} "print_stacktrace=1")
