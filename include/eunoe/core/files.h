#ifndef eunoe_core_files_h
#define eunoe_core_files_h

#include <fstream>
#include <mpi.h>
#include <string>

namespace eunoe {

/// A text of a rank, the first one as a rule, given to every rank; collective.
std::string broadcast(std::string text, MPI_Comm comm, int from = 0);

/// Opens a file for reading. Throws a UserError if it cannot be read.
std::ifstream open_for_reading(const std::string &path);

/// The whole text of a file, read once and given to every rank; collective.
/// Throws a UserError on every rank if it cannot be read.
std::string read_file(const std::string &path, MPI_Comm comm);

/// Writes a file beside the old one and renames it when it is complete. To be called by one rank.
/// Throws a UserError if that fails, and leaves the old file as it was.
/// @param sync waits until the file would survive a crash of the machine
void write_file(const std::string &path, const std::string &text, bool sync = false);

/// Writes the texts of all ranks one behind the other, in the same way, each its own; collective.
/// Throws a UserError on every rank.
void write_in_parts(const std::string &path, const std::string &mine, MPI_Comm comm);

/// Size of a file (bytes), 0 if there is none.
double file_size(const std::string &path);

/// Removes a file if there is one. To be called by one rank.
void remove_file(const std::string &path);

/// Creates a folder and those above it, on one rank of @p comm; collective.
/// Throws a UserError on every rank if it cannot be written to.
void create_folder(const std::string &path, MPI_Comm comm);

} // namespace eunoe

#endif
