#include <eunoe/contact/contact_model.h>

#include <algorithm>
#include <cstring>

namespace eunoe {

namespace {

const char *const families[] = {"normal", "cohesion", "further", "tangential", "rolling"};

} // namespace

ContactLawRegistry &contact_laws(const std::string &family)
{
  static RegistryFamilies<ContactLawRegistry> registries(
      "contact law", {std::begin(families), std::end(families)});
  return registries[family];
}

ContactModelRegistry &contact_models()
{
  static ContactModelRegistry registry("contact model");
  return registry;
}

ContactLawSections::ContactLawSections()
{
  for (const std::string family : families)
    sections[family] = contact_laws(family).make_all();
}

void ContactLawSections::declare(dealii::ParameterHandler &prm)
{
  for (auto &[family, laws] : sections)
    for (auto &[name, section] : laws)
      section->declare(prm);
}

void ContactLawSections::check(const ParameterCheck &check) const
{
  for (const auto &[family, laws] : sections)
    for (const auto &[name, section] : laws)
      section->check(check);
}

ContactModel::ContactModel(Materials materials_, const ContactModelNames &names,
                           const ContactLawSections &sections, const double largest_radius,
                           const bool is_of_walls)
    : materials(std::move(materials_))
{
  const auto add = [&](const std::string &family, const std::string &name) {
    const auto &known = sections.of_family(family);
    const auto section = known.find(name);
    if (section == known.end())
      throw std::invalid_argument("there is no '" + name + "' among " +
                                  contact_laws(family).names());
    if (auto law = section->second->make(materials, largest_radius)) {
      laws.push_back(std::move(law));
      text += (text.empty() ? "" : ", ") + name;
    }
  };
  add("normal", names.normal);
  for (const std::string &name : names.cohesion)
    add("cohesion", name);
  for (const auto &further : sections.of_family("further"))
    add("further", further.first);
  add("tangential", names.tangential);
  if (names.rolling != "none")
    add("rolling", names.rolling);

  for (const auto &law : laws) {
    first_history.push_back(n_history);
    n_history += law->history_size();
    const int walls_begin = materials.n_types(), walls_end = materials.size();
    for (int first = 0; first < walls_begin; ++first)
      for (int second = is_of_walls ? walls_begin : 0;
           second < (is_of_walls ? walls_end : walls_begin); ++second)
        largest_range = std::max(largest_range, law->range(materials.kind(first, second)));
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
