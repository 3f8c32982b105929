#include <eunoe/simulation/simulation.h>

namespace eunoe {
namespace {

/// Coordination number and forces per contact of every particle, in its pictures. Contacts count
/// that have an overlap, so that the number is that of touching surfaces, not of attracting
/// neighbours; a solid may have several with one particle.
class ContactFields : public Observable
{
public:
  ContactFields(const SwitchSection &, Simulation &) {}

  std::vector<PictureField> fields(Simulation &simulation) const override
  {
    const ParticleArrays &p = simulation.complete_step();
    std::vector<double> number(p.n_owned, 0.), normal = number, tangential = number;
    for (const ContactForce &contact : simulation.contact_forces())
      if (contact.overlap > 0.)
        for (const std::int32_t row : {contact.first, contact.second})
          if (row >= 0 && static_cast<std::size_t>(row) < p.n_owned) {
            ++number[row];
            normal[row] += contact.normal_force;
            tangential[row] += norm(contact.tangential_force);
          }
    for (std::size_t k = 0; k < p.n_owned; ++k)
      if (number[k] > 0.) {
        normal[k] /= number[k];
        tangential[k] /= number[k];
      }
    return {{"coordination_number", 1, number},
            {"normal_force_per_contact", 1, normal},
            {"tangential_force_per_contact", 1, tangential}};
  }
};

const ObservableRegistry::Registration registration(observables(), "contact fields", [] {
  return std::make_unique<SectionOf<ContactFields, SwitchSection>>(
      "contact fields",
      "Whether the particles in pictures have their coordination number, which counts "
      "contacts with an overlap, and the mean normal and tangential force of "
      "these contacts.");
});

} // namespace
} // namespace eunoe
