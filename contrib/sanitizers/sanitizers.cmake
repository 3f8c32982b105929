# A build in which sanitizers watch (CMake option EUNOE_SANITIZE): what they find ends the program
# with a report, so a test fails. CONTRIBUTING.md tells how to use it.

string(TOUPPER "${EUNOE_SANITIZE}" wish)
if(wish MATCHES "^(ON|TRUE|YES|1)$")
  set(sanitizers address,undefined)
else()
  string(REPLACE ";" "," sanitizers "${EUNOE_SANITIZE}")
endif()
set(options -fsanitize=${sanitizers} -fno-sanitize-recover=all -fno-omit-frame-pointer)
if(sanitizers MATCHES "undefined")
  list(APPEND options -fsanitize=float-cast-overflow)
endif()

# All targets, and those of the tests: what a sanitizer does not see it may report wrongly.
add_compile_options(${options})
add_link_options(${options})
# The indices of vectors and other containers are checked, too. (Warnings are not errors here: GCC
# takes instrumented code for faulty where it is not.)
add_compile_definitions(_GLIBCXX_ASSERTIONS)
