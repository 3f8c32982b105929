#ifndef eunoe_tests_one_contact_h
#define eunoe_tests_one_contact_h

// Single contacts as the laws see them, without particles around, for tests that compare a law with
// its formula.

#include <eunoe/contact/contact_model.h>

#include "tests.h"

#include <array>
#include <memory>
#include <random>
#include <vector>

namespace test {

/// Inputs of the laws for a contact, and its memory.
struct Contact
{
  Vec3 normal = {1., 0., 0.};
  double overlap = 0.;
  double distance = 0.; ///< of the centres (m); 0: as for two equal spheres
  double radius = 1e-3, mass = 1e-6, inertia = 1e-13;
  double closing_speed = 0.;
  Vec3 slip, roll;
  double twist = 0.;
  int kind = 0;
  std::array<double, PairBlock::max_history> history = {};
};

/// Results of the laws: forces on j, repulsion positive, and the torque on i.
struct Response
{
  double stiffness, contact_force, cohesion;
  Vec3 shear, torque;
};

/// The laws of a simulation, applied to contacts by hand.
class Laws
{
public:
  /// @param entries of `subsection model parameters`, as an input file has them
  /// @param largest_radius of the particles (m)
  Laws(const std::vector<Material> &materials, int n_particle_types, const ContactModelNames &names,
       const std::string &entries = "", double largest_radius = 0.)
      : model(Materials(materials, n_particle_types), names, sections_of(entries), largest_radius)
  {
  }

  /// Applies all laws to at most 64 contacts at once; the rest of the block holds copies of the
  /// last contact, as in the engine. The memory of the contacts advances by @p dt.
  std::vector<Response> apply(std::vector<Contact> &contacts, double dt)
  {
    OwnPairBlock &b = *block;
    b.n = static_cast<unsigned int>(contacts.size());
    b.uniform_kind = model.get_materials().only_particle_kind();
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const Contact &c = contacts[std::min<std::size_t>(k, contacts.size() - 1)];
      set(b.nx, b.ny, b.nz, k, c.normal);
      set(b.slip_x, b.slip_y, b.slip_z, k, c.slip);
      set(b.roll_x, b.roll_y, b.roll_z, k, c.roll);
      b.twist[k] = c.twist;
      b.overlap[k] = c.overlap;
      b.distance[k] = c.distance > 0. ? c.distance : 4. * c.radius - c.overlap;
      b.radius[k] = c.radius;
      b.mass[k] = c.mass;
      b.inertia[k] = c.inertia;
      b.closing_speed[k] = c.closing_speed;
      b.own_kind[k] = c.kind;
      for (unsigned int h = 0; h < PairBlock::max_history; ++h)
        b.history[h][k] = c.history[h];
    }
    model.apply(b, dt);
    std::vector<Response> responses;
    for (unsigned int k = 0; k < b.n; ++k) {
      for (unsigned int h = 0; h < PairBlock::max_history; ++h)
        contacts[k].history[h] = b.history[h][k];
      responses.push_back({b.stiffness[k],
                           b.contact_force[k],
                           b.cohesion[k],
                           {b.shear_x[k], b.shear_y[k], b.shear_z[k]},
                           {b.torque_x[k], b.torque_y[k], b.torque_z[k]}});
    }
    return responses;
  }

  Response apply(Contact &contact, double dt)
  {
    std::vector<Contact> one = {contact};
    const Response response = apply(one, dt).front();
    contact = one.front();
    return response;
  }

  const ContactModel model;

private:
  static ContactLawSections sections_of(const std::string &entries)
  {
    ContactLawSections sections;
    test::read_entries([&](dealii::ParameterHandler &prm) { sections.declare(prm); },
                       "subsection model parameters\n" + entries + "\nend\n");
    return sections;
  }

  static void set(double *x, double *y, double *z, unsigned int k, const Vec3 &v)
  {
    x[k] = v.x;
    y[k] = v.y;
    z[k] = v.z;
  }

  std::unique_ptr<OwnPairBlock> block = std::make_unique<OwnPairBlock>();
};

/// A full block of contacts that all differ, with overlaps and separations up to @p depth (m).
inline std::vector<Contact> different_contacts(double depth)
{
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> unit(-1., 1.);
  const auto vector = [&] { return Vec3{unit(generator), unit(generator), unit(generator)}; };
  std::vector<Contact> contacts(PairBlock::size);
  for (Contact &c : contacts) {
    c.normal = vector();
    c.normal = c.normal / norm(c.normal);
    const auto in_plane = [&](const Vec3 &v) { return v - dot(v, c.normal) * c.normal; };
    c.overlap = depth * unit(generator);
    c.radius = 1e-3 * (1.5 + unit(generator));
    c.mass = 1e-6 * (1.5 + unit(generator));
    c.inertia = 1e-13 * (1.5 + unit(generator));
    c.closing_speed = unit(generator);
    c.slip = in_plane(vector());
    const Vec3 spin = 100. * vector();
    c.roll = in_plane(spin);
    c.twist = dot(spin, c.normal);
  }
  return contacts;
}

/// Norm of the difference from a list of references over the norm of the references.
inline double relative_error(const std::vector<Vec3> &values, const std::vector<Vec3> &references)
{
  double error = 0., scale = 0.;
  for (std::size_t k = 0; k < values.size(); ++k) {
    error += norm_square(values[k] - references[k]);
    scale += norm_square(references[k]);
  }
  return std::sqrt(error / scale);
}

inline double relative_error(const std::vector<double> &values,
                             const std::vector<double> &references)
{
  std::vector<Vec3> a, b;
  for (std::size_t k = 0; k < values.size(); ++k) {
    a.push_back({values[k], 0., 0.});
    b.push_back({references[k], 0., 0.});
  }
  return relative_error(a, b);
}

/// A line of an input file that sets an entry to a number with all its digits.
inline std::string set_entry(const std::string &entry, double value)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return "set " + entry + " = " + text + "\n";
}

} // namespace test

#endif
