# Writes OUTPUT with a digest of the files whose names stand in LIST, and of COMPILER, so that runs
# of an engine that gives other results are not taken for its own.
#   cmake -DLIST=... -DCOMPILER=... -DOUTPUT=... -P engine_digest.cmake
file(STRINGS ${LIST} files)
set(digests "${COMPILER}")
foreach(file ${files})
  file(SHA256 ${file} digest)
  string(APPEND digests "${digest}")
endforeach()
string(SHA256 digest "${digests}")
file(WRITE ${OUTPUT} "#include <eunoe/core/version.h>

const char *eunoe::engine_digest() { return \"${digest}\"; }
")
