# Settings of the sanitizers for all tests; ctest reads this file before it runs them.
# What is suppressed and why stands in the files of this folder.

set(ENV{ASAN_OPTIONS} "detect_stack_use_after_return=1:strict_string_checks=1")
set(ENV{LSAN_OPTIONS} "suppressions=${CMAKE_CURRENT_LIST_DIR}/leaks.txt:print_suppressions=0")
set(ENV{UBSAN_OPTIONS} "print_stacktrace=1")
