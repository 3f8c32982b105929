#ifndef eunoe_engine_solid_contacts_h
#define eunoe_engine_solid_contacts_h

#include <eunoe/contact/contact_force.h>
#include <eunoe/contact/contact_memory.h>
#include <eunoe/contact/contact_model.h>
#include <eunoe/solids/solid.h>
#include <eunoe/state/particle_arrays.h>

#include <array>

namespace eunoe {

/// The contacts of particles with solids: what is near since the last search, what touches, and
/// what it remembers. Goes through the same laws as contacts between particles.
class SolidContacts
{
public:
  /// A particle near a solid.
  struct Candidate
  {
    std::int32_t particle, solid;
    std::int32_t first_facet, n_facets;
    std::int32_t plane; ///< that stands for the facets until the next search, -1 if none does
    std::uint32_t n_living = 0;
    float separation = 0.f; ///< least separation at the search (m), rounded down
    /// Records of the contacts that touched at the last step.
    std::array<std::int32_t, Shape::max_contacts> living;
  };

  explicit SolidContacts(const ContactModel &model);

  /// Lists every owned particle whose separation from a solid's surface, where its reference is, is
  /// at most @p reach (m), ordered by particle and solid. All contacts are forgotten.
  void search(const ParticleArrays &particles, const std::vector<Solid> &solids, double reach);

  /// Takes particles out. To be called before `search_again`.
  void leave_out(const Remaining &remaining);

  /// Likewise for the same particles in the same rows; every contact keeps its memory.
  void search_again(const ParticleArrays &particles, const std::vector<Solid> &solids,
                    double reach);

  /// Adds the forces and torques on the owned particles and advances the memory by @p dt.
  /// @param loads if not null, one per solid: what the particles exert is added to it
  void add_forces(ParticleArrays &particles, const std::vector<Solid> &solids, double time,
                  double dt, std::vector<SolidLoad> *loads);

  /// Gives the present forces of all contacts, also of sleepers, to @p sink. The memory of contacts
  /// does not change.
  void evaluate(const ParticleArrays &particles, const std::vector<Solid> &solids, double time,
                const ContactForceSink &sink) const;

  /// @name Memory of the living contacts
  ///@{
  const std::vector<Candidate> &get_candidates() const { return candidates; }
  const double *history(std::int32_t record) const { return memory[record]; }
  /// Normal in the solid's own frame, by which a contact is recognised at the next step.
  const Vec3 &normal(std::int32_t record) const { return normals[record]; }
  /// Depth of a sphere in a solid near it (m), negative if they do not touch.
  double deepest_overlap(const Candidate &candidate, const Solid &solid, const Vec3 &centre,
                         double radius) const;
  /// Lets every contact begin anew.
  void forget();
  /// Gives the candidate (particle, solid) a contact with a memory; without effect if the two are
  /// no longer near each other.
  void restore(std::int32_t particle, std::int32_t solid, const Vec3 &normal,
               const double *history);
  ///@}

private:
  /// A block for the laws, with further data of its contacts.
  struct Batch : public OwnPairBlock
  {
    std::array<std::int32_t, size> particle, solid;
    std::array<std::int32_t, size> record; ///< in which the memory is kept, none for a sleeper's
    std::array<Vec3, size> point;
  };

  /// How far each solid has moved since the search (m).
  std::vector<double> ways(const std::vector<Solid> &solids) const;
  /// Whether a candidate cannot have touched since the search and has no contact that could end.
  /// @param way that its solid has moved since (m)
  bool is_far(const Candidate &candidate, const ParticleArrays &particles, double way) const;
  /// The contacts of a sphere with the solid that it is near.
  unsigned int find(const Candidate &candidate, const Solid &solid, const Vec3 &position,
                    double radius, SurfaceContact *found) const;
  /// Adds a contact to a batch.
  /// @param record of its history, none for a contact that has just begun
  void add_to(Batch &batch, const ParticleArrays &particles, const Solid &solid,
              const Candidate &candidate, const SurfaceContact &contact, std::int32_t record) const;
  /// Runs the laws.
  void apply_laws(Batch &batch, double dt) const;
  static ContactForce force_of(const Batch &batch, unsigned int k);
  /// Adds the batch's forces, keeps what its contacts remember and empties it.
  void finish(ParticleArrays &particles, const std::vector<Solid> &solids, double dt,
              std::vector<SolidLoad> *loads);
  std::int32_t create(const Vec3 &normal);
  /// Takes the living contact with nearly the same normal out of a candidate: a contact moves by a
  /// tiny part of the particle's size in a step, over any edge. `ContactMemory::none` without such
  /// a contact.
  std::int32_t take_living(Candidate &candidate, const Vec3 &normal) const;
  /// Contacts that were found continue or begin; contacts that were not found have ended.
  void go_on(Candidate &candidate, const SurfaceContact *found, unsigned int n_found);

  const ContactModel &model;
  std::vector<RigidState> solids_at_search;
  std::vector<Candidate> candidates;
  std::vector<std::int32_t> facets;
  std::vector<Plane> planes;
  ContactMemory memory;
  std::vector<Vec3> normals;
  std::unique_ptr<Batch> batch;
};

} // namespace eunoe

#endif
