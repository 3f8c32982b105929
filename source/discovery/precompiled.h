#ifndef eunoe_source_discovery_precompiled_h
#define eunoe_source_discovery_precompiled_h

// Headers that most files of discovery share and that take long to compile.

#include <nlohmann/json.hpp>

#include <Eigen/Dense>
#include <map>
#include <string>
#include <vector>

#endif
