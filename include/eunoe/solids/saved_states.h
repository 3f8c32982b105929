#ifndef eunoe_solids_saved_states_h
#define eunoe_solids_saved_states_h

#include <eunoe/solids/solid.h>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace eunoe {

/// Where solids are, for a checkpoint, and their return. The latter throw a std::invalid_argument
/// or an exception of the JSON library for what is none.
///@{
nlohmann::ordered_json to_json(const RigidState &state);
nlohmann::ordered_json to_json(const std::vector<RigidState> &states);
RigidState state_in(const nlohmann::ordered_json &json);
/// @param n number of the states
std::vector<RigidState> states_in(const nlohmann::ordered_json &json, std::size_t n);
///@}

std::vector<RigidState> states_of(const std::vector<Solid> &solids);
std::vector<std::string> names_of(const std::vector<Solid> &solids);

/// The present numbers of saved solids by their names, -1 for one that is gone. Flat walls of one
/// boundary share a name; they have kept their order.
std::vector<int> numbers_now(const std::vector<std::string> &saved,
                             const std::vector<std::string> &present);

} // namespace eunoe

#endif
