#include <eunoe/simulation/patch_list.h>
#include <eunoe/simulation/simulation.h>

#include <algorithm>
#include <tuple>

namespace eunoe {
namespace {

/// Contacts as lines with data that are constant on each, in the form in which deal.II writes them.
class ContactLines : public PatchList<1>
{
public:
  ContactLines()
  {
    for (const char *const name : {"normal_force", "tangential_force", "overlap", "solid"})
      add_name(name);
  }

  /// A line from the centre of the first body to that of the second, or to the solid's surface. It
  /// begins in the first body's place, wherever beyond a periodic face the second has its own.
  void add(const ContactForce &contact, const ParticleArrays &p)
  {
    Patch patch;
    patch.patch_index = static_cast<unsigned int>(patches.size());
    patch.n_subdivisions = 1;
    patch.reference_cell = dealii::ReferenceCells::Line;
    const Vec3 begin = p.position[contact.first].vec();
    const Vec3 end = begin + contact.distance * contact.normal;
    patch.vertices[0] = {begin.x, begin.y, begin.z};
    patch.vertices[1] = {end.x, end.y, end.z};
    const double values[] = {contact.normal_force, norm(contact.tangential_force), contact.overlap,
                             static_cast<double>(contact.solid)};
    patch.data.reinit(n_data(), 2);
    for (unsigned int c = 0; c < n_data(); ++c)
      patch.data(c, 0) = patch.data(c, 1) = static_cast<float>(values[c]);
    patches.push_back(patch);
    ids[0].values.insert(ids[0].values.end(), 2, p.id[contact.first]);
    ids[1].values.insert(ids[1].values.end(), 2,
                         contact.second < 0 ? -1 : std::int64_t(p.id[contact.second]));
  }

  /// Of the particles of every contact, at both ends of its line.
  std::vector<PictureIntegers> ids = {{"first", {}}, {"second", {}}};
};

/// All contacts with their forces, as pictures.
class ForceChains : public Observable
{
public:
  ForceChains(const SwitchSection &, Simulation &simulation)
      : pictures(simulation.output_folder().pictures(
            simulation.get_parameters().control.output_name + "_force_chains"))
  {
  }

  void draw(Simulation &simulation) override
  {
    const ParticleArrays &p = simulation.complete_step();
    std::vector<ContactForce> contacts = simulation.contact_forces();
    const auto is_drawn = [&p](const ContactForce &c) {
      // A contact of two ranks is drawn by that of the first particle.
      return static_cast<std::size_t>(c.first) < p.n_owned &&
             (c.overlap > 0. || c.normal_force != 0.);
    };
    const auto key = [&p](const ContactForce &c) {
      return std::make_tuple(p.id[c.first], c.second < 0 ? 0 : p.id[c.second], c.solid, c.normal.x,
                             c.normal.y, c.normal.z);
    };
    std::sort(contacts.begin(), contacts.end(),
              [&key](const ContactForce &a, const ContactForce &b) { return key(a) < key(b); });
    ContactLines lines;
    for (const ContactForce &contact : contacts)
      if (is_drawn(contact))
        lines.add(contact, p);
    pictures->write(simulation.time(), lines, lines.ids);
  }

private:
  const std::shared_ptr<PictureSeries> pictures;
};

const ObservableRegistry::Registration registration(observables(), "force chains", [] {
  return std::make_unique<SectionOf<ForceChains, SwitchSection>>(
      "force chains", "Whether all contacts are drawn with every picture, as lines with their "
                      "forces and overlaps.");
});

} // namespace
} // namespace eunoe
