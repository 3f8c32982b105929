#ifndef eunoe_contact_contact_model_h
#define eunoe_contact_contact_model_h

#include <eunoe/contact/contact_law.h>

#include <algorithm>

namespace eunoe {

/// Which laws act in a contact, by family and registered name, in the order of their application.
struct ContactModelNames
{
  std::string normal = "hertz";
  std::vector<std::string> cohesion;
  std::string tangential = "mindlin_limit_overlap";
  std::string rolling = "constant"; ///< "none" for no resistance
};

/// A model that the input names.
struct NamedContactModel
{
  std::string wall_name; ///< of the same laws between particles and walls
  ContactModelNames laws;
  bool has_adhesion = false; ///< by the surface energy
};

/// Models by the names of the input. A model is registered beside the law that distinguishes it.
using ContactModelRegistry = Registry<NamedContactModel>;
ContactModelRegistry &contact_models();

/// What the input says of all laws.
class ContactLawSections : public ParameterSection
{
public:
  ContactLawSections();

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;

  const std::map<std::string, std::shared_ptr<ContactLawSection>> &of_family(
      const std::string &family) const
  {
    return sections.at(family);
  }

private:
  std::map<std::string, std::map<std::string, std::shared_ptr<ContactLawSection>>> sections;
};

/// The laws of a contact, composed at run time: normal, cohesion, further ones that the input and
/// the materials ask for, tangential, rolling.
class ContactModel
{
public:
  /// @param sections of the laws, with their coefficients
  /// @param largest_radius of the particles (m)
  /// @param is_of_walls whether one of the two bodies is a wall or solid
  ContactModel(Materials materials, const ContactModelNames &names,
               const ContactLawSections &sections, double largest_radius, bool is_of_walls = false);

  /// Number of doubles that a contact remembers.
  unsigned int history_size() const { return n_history; }

  /// Lets every contact remember at least so many, of which its laws need not use all: where
  /// contacts of two models go the same ways, all have the same size.
  void widen(unsigned int n) { n_history = std::max(n_history, n); }

  /// Largest separation at which some law acts between any two materials that meet (m).
  double range() const { return largest_range; }

  /// Runs all laws over a block whose geometry and history are filled in.
  void apply(PairBlock &block, double dt) const;

  /// Turns what a contact remembers into that of its mirror image.
  /// @param axis normal to the mirror: 0, 1 or 2
  void mirror(double *history, unsigned int axis) const;

  const Materials &get_materials() const { return materials; }

  /// Names of the laws: what contacts remember has the same meaning in models with the same text.
  const std::string &description() const { return text; }

private:
  const Materials materials;
  std::vector<std::unique_ptr<ContactLaw>> laws;
  std::vector<unsigned int> first_history;
  std::string text;
  unsigned int n_history = 0;
  double largest_range = 0.;
};

} // namespace eunoe

#endif
