#include <eunoe/checkpoint/head_values.h>
#include <eunoe/engine/contact_rows.h>
#include <eunoe/engine/saved_layout.h>
#include <eunoe/solids/saved_states.h>

#include <algorithm>

namespace eunoe {

namespace {

using Json = nlohmann::ordered_json;

const std::string key = "layout";

/// Doubles of a particle, more than anything needs.
constexpr unsigned int most_extra = 1u << 20;

} // namespace

void SavedLayout::write(Json &head, const ParticleFields &fields, const ContactModel &pairs,
                        const ContactModel &walls)
{
  Json list = Json::array();
  for (const ParticleField &field : fields.list())
    list.push_back({{"name", field.name}, {"components", field.n_components}});
  head[key] = {{"fields", list},
               {"pair_laws", pairs.description()},
               {"wall_laws", walls.description()},
               {"history", pairs.history_size()}};
}

SavedLayout::SavedLayout(const Json &head, const ParticleFields &fields, const ContactModel &pairs,
                         const ContactModel &walls, const std::vector<Solid> &solids)
    : saved_history(count_in<unsigned int>(head.at(key).at("history"))),
      present_history(pairs.history_size()),
      keeps_pairs(head.at(key).at("pair_laws") == pairs.description()),
      keeps_walls(head.at(key).at("wall_laws") == walls.description())
{
  const Json &layout = head.at(key);
  std::map<std::string, std::pair<unsigned int, unsigned int>> saved; // place and number
  for (const Json &field : layout.at("fields")) {
    const auto n = count_in<unsigned int>(field.at("components"));
    // Of a damaged one the sum would begin again at 0.
    if (n > most_extra - saved_extra)
      throw std::invalid_argument("these are no components");
    saved[field.at("name")] = {saved_extra, n};
    saved_extra += n;
  }
  for (const ParticleField &field : fields.list()) {
    const auto found = saved.find(field.name);
    const bool goes_on = found != saved.end() && found->second.second == field.n_components;
    for (unsigned int c = 0; c < field.n_components; ++c)
      extras.push_back(goes_on ? static_cast<int>(found->second.first + c) : -1);
  }
  const auto names = head.at("solids").at("names").get<std::vector<std::string>>();
  numbers = numbers_now(names, names_of(solids));
  for (std::size_t k = 0; k < names.size(); ++k)
    if (numbers[k] < 0)
      gone += (gone.empty() ? "'" : ", '") + names[k] + "'";
}

Rows SavedLayout::translate(const Rows &saved) const
{
  const ContactRows before(saved_history, saved);
  ContactRows now(present_history);
  std::vector<double> history(std::max(saved_history, present_history), 0.);
  for (std::size_t row = 0; row < before.size(); ++row) {
    now.start_row();
    for (ContactRows::Record record : before.records(row)) {
      if (!(record.with_solid ? keeps_walls : keeps_pairs))
        continue;
      if (record.with_solid) {
        const int number = record.partner < numbers.size() ? numbers[record.partner] : -1;
        if (number < 0)
          continue;
        record.partner = static_cast<std::uint32_t>(number);
      }
      std::copy_n(record.history, saved_history, history.begin());
      record.history = history.data();
      now.add(record);
    }
  }
  return now.get_rows();
}

std::vector<std::string> SavedLayout::losses() const
{
  std::vector<std::string> list;
  if (!keeps_pairs)
    list.emplace_back("Contacts of particles obey other laws now and begin anew.");
  if (!keeps_walls)
    list.emplace_back("Contacts with walls and solids obey other laws now and begin anew.");
  if (!gone.empty())
    list.push_back("Gone are " + gone + ".");
  return list;
}

} // namespace eunoe
