#ifndef eunoe_core_version_h
#define eunoe_core_version_h

namespace eunoe {

/// Version of Eunoe, "1.0.0".
const char *version();
/// Revision from which it was built, "unknown" outside a git checkout.
const char *git_revision();
/// Folder of the sources from which it was built.
const char *source_folder();
/// Digest of all that decides what a simulation gives: the engine's sources and its compiler. Two
/// programs with the same digest give the same bits.
const char *engine_digest();
/// Version of deal.II that it was built with.
const char *deal_ii_version();

} // namespace eunoe

#endif
