// The file that a library must have; the precompiled header beside it is what it is for.
#include "tests.h"
