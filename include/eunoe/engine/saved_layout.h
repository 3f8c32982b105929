#ifndef eunoe_engine_saved_layout_h
#define eunoe_engine_saved_layout_h

#include <eunoe/contact/contact_model.h>
#include <eunoe/core/rows.h>
#include <eunoe/solids/solid.h>
#include <eunoe/state/particle_field.h>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace eunoe {

/// What the doubles of particles and contacts in a checkpoint mean to a run whose input may be
/// another one: fields and solids are found by their names.
class SavedLayout
{
public:
  /// Adds what the constructor reads.
  static void write(nlohmann::ordered_json &head, const ParticleFields &fields,
                    const ContactModel &pairs, const ContactModel &walls);

  /// @param head of the checkpoint
  SavedLayout(const nlohmann::ordered_json &head, const ParticleFields &fields,
              const ContactModel &pairs, const ContactModel &walls,
              const std::vector<Solid> &solids);

  /// Number of extra doubles of a saved particle, and of doubles that a saved contact remembers.
  unsigned int n_extra() const { return saved_extra; }
  unsigned int n_history() const { return saved_history; }

  /// The saved extra double that a present one continues, -1 for one that is new.
  int extra(std::size_t e) const { return extras[e]; }

  /// What contacts remember, with the present numbers of solids; those with solids that are gone,
  /// and all of a family whose laws are others now, begin anew.
  Rows translate(const Rows &saved) const;

  /// What is lost, in sentences.
  std::vector<std::string> losses() const;

private:
  unsigned int saved_extra = 0, saved_history = 0, present_history = 0;
  std::vector<int> extras;  ///< by present extra double
  std::vector<int> numbers; ///< of the saved solids in the present run, -1 for one that is gone
  std::string gone;         ///< names of these
  bool keeps_pairs = true, keeps_walls = true;
};

} // namespace eunoe

#endif
