# A build with sanitizers (CMake option EUNOE_SANITIZE): a finding ends the program with a report,
# so a test fails. CONTRIBUTING.md says how to use it.

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

# For all targets, tests too: code without instrumentation may cause wrong reports.
add_compile_options(${options})
add_link_options(${options})
# The indices of vectors and other containers are checked, too. (Warnings are not errors here, as
# GCC gives false warnings on instrumented code.)
add_compile_definitions(_GLIBCXX_ASSERTIONS)
