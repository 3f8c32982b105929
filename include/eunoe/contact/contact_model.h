#ifndef eunoe_contact_contact_model_h
#define eunoe_contact_contact_model_h

#include <eunoe/contact/contact_law.h>

namespace eunoe {

/// Which laws act in a contact, by family and registered name, in the order of their application.
struct ContactModelNames
{
  std::string normal = "hertz";
  std::vector<std::string> cohesion;
  std::string tangential = "mindlin_limit_overlap";
  std::string rolling = "constant"; ///< "none" for no resistance
};

/// The laws of a contact, composed at run time: normal, cohesion, further ones that the options and
/// materials ask for, tangential, rolling.
/// Particle-particle and particle-solid contacts go through the same one.
class ContactModel
{
public:
  ContactModel(Materials materials, const ContactModelNames &names,
               const ContactLawOptions &options = {});

  /// Number of doubles that a contact remembers.
  unsigned int history_size() const { return n_history; }

  /// Largest gap across which some law acts between any two materials (m).
  double range() const { return largest_range; }

  /// Runs all laws over a block whose geometry and history are filled in.
  void apply(PairBlock &block, double dt) const;

  /// Turns what a contact remembers into that of its mirror image.
  /// @param axis normal to the mirror: 0, 1 or 2
  void mirror(double *history, unsigned int axis) const;

  const Materials &get_materials() const { return materials; }

private:
  const Materials materials;
  std::vector<std::unique_ptr<ContactLaw>> laws;
  std::vector<unsigned int> first_history;
  unsigned int n_history = 0;
  double largest_range = 0.;
};

} // namespace eunoe

#endif
