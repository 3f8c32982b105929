#include <eunoe/contact/contact_model.h>

#include <algorithm>
#include <cstring>

namespace eunoe {

ContactLawRegistry &contact_laws(const std::string &family)
{
  static RegistryFamilies<ContactLawRegistry> registries(
      "contact law", {"normal", "cohesion", "further", "tangential", "rolling"});
  return registries[family];
}

ContactModel::ContactModel(Materials materials_, const ContactModelNames &names,
                           const ContactLawOptions &options)
    : materials(std::move(materials_))
{
  const auto add = [&](const std::string &family, const std::string &name) {
    if (auto law = contact_laws(family).make(name, materials, options))
      laws.push_back(std::move(law));
  };
  add("normal", names.normal);
  for (const std::string &name : names.cohesion)
    add("cohesion", name);
  for (const std::string &name : contact_laws("further").list())
    add("further", name);
  add("tangential", names.tangential);
  if (names.rolling != "none")
    add("rolling", names.rolling);

  for (const auto &law : laws) {
    first_history.push_back(n_history);
    n_history += law->history_size();
    for (int kind = 0; kind < materials.size() * materials.size(); ++kind)
      largest_range = std::max(largest_range, law->range(kind));
  }
  if (n_history > PairBlock::max_history)
    throw std::invalid_argument("these laws together remember " + std::to_string(n_history) +
                                " numbers a contact, more than the " +
                                std::to_string(PairBlock::max_history) + " that fit in a block");
}

void ContactModel::mirror(double *history, const unsigned int axis) const
{
  for (std::size_t l = 0; l < laws.size(); ++l)
    laws[l]->mirror(history + first_history[l], axis);
}

void ContactModel::apply(PairBlock &block, const double dt) const
{
  std::memset(static_cast<ContactForces *>(&block), 0, sizeof(ContactForces));
  for (std::size_t l = 0; l < laws.size(); ++l)
    laws[l]->apply(block, first_history[l], dt);
}

} // namespace eunoe
