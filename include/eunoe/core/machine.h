#ifndef eunoe_core_machine_h
#define eunoe_core_machine_h

#include <string>

namespace eunoe {

/// Memory of this machine that can be used, or what a container leaves of it (bytes); 0 if that is
/// not known.
double usable_memory();

/// Free bytes of the disk that holds a path, which need not exist yet; 0 if that is not known.
double free_disk_space(const std::string &path);

/// Why a folder could not be created or written to, empty if nothing stands against it. Looks only.
std::string obstacle_to_folder(const std::string &path);

/// Of this machine, for messages.
std::string host_name();

/// "1.2 GB" or "35 MB".
std::string format_bytes(double bytes);

} // namespace eunoe

#endif
