#ifndef eunoe_core_version_h
#define eunoe_core_version_h

namespace eunoe {

/// Version of Eunoe, "1.0.0".
const char *version();
/// Revision from which it was built, "unknown" outside a git checkout.
const char *git_revision();
/// Version of deal.II that it was built with.
const char *deal_ii_version();

} // namespace eunoe

#endif
