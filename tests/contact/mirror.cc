// The memory of a contact can be mirrored: a mirrored contact with a mirrored memory gives the
// mirrored force and torque.

#include "../one_contact.h"

using namespace test;

namespace {

/// Mirror image of a displacement or force; spins and torques change their sign as well.
Vec3 mirrored(Vec3 v, unsigned int axis)
{
  v[axis] = -v[axis];
  return v;
}

} // namespace

EUNOE_TEST()
{
  Material material;
  material.surface_energy = 0.01;
  for (const std::string normal : {"hertz", "jkr"})
    for (const std::string rolling : {"none", "constant", "epsd"})
      for (const std::string tangential : {"mindlin_limit_overlap", "mindlin_limit_force"})
        for (unsigned int axis = 0; axis < 3; ++axis) {
          Laws laws({material}, 1, {normal, {"dmt"}, tangential, rolling});
          std::vector<Contact> contacts = different_contacts(1e-6);
          for (Contact &c : contacts)
            c.overlap = std::abs(c.overlap);
          laws.apply(contacts, 1e-7);
          std::vector<Contact> images = contacts;
          bool remembers = false;
          for (Contact &c : images) {
            for (const double h : c.history)
              remembers = remembers || h != 0.;
            c.normal = mirrored(c.normal, axis);
            c.slip = mirrored(c.slip, axis);
            c.roll = -mirrored(c.roll, axis);
            c.twist = -c.twist;
            laws.model.mirror(c.history.data(), axis);
          }
          const std::vector<Response> originals = laws.apply(contacts, 1e-7);
          const std::vector<Response> reflections = laws.apply(images, 1e-7);
          bool alike = remembers;
          for (std::size_t k = 0; k < contacts.size(); ++k)
            alike = alike && reflections[k].shear == mirrored(originals[k].shear, axis) &&
                    reflections[k].torque == -mirrored(originals[k].torque, axis);
          check(normal + ", " + tangential + " and " + rolling + " in a mirror across axis " +
                    std::to_string(axis),
                alike);
        }
}
