#ifndef eunoe_engine_contact_rows_h
#define eunoe_engine_contact_rows_h

#include <eunoe/contact/pair_list.h>
#include <eunoe/core/rows.h>
#include <eunoe/engine/solid_contacts.h>
#include <eunoe/state/particle_arrays.h>

#include <utility>

namespace eunoe {

/// The memory of contacts by particle, while lists are rebuilt: one row per particle, with one
/// record per contact. A pair of particles is in the rows of both, so that either particle can take
/// it along to another rank; both copies have the same bits.
class ContactRows
{
public:
  ContactRows(unsigned int n_history, Rows rows = {}) : n_history(n_history), rows(std::move(rows))
  {
  }

  std::size_t size() const { return rows.size(); }
  const Rows &get_rows() const { return rows; }

  /// Collects the rows of all owned particles, in their order.
  void collect(const ParticleArrays &particles, const PairList &pairs, const SolidContacts &solids);

  /// Gives rows back to freshly built lists.
  /// @param views of the owned particles' rows in their order
  void attach(const RowViews &views, const ParticleArrays &particles, PairList &pairs,
              SolidContacts &solids) const;

  /// @name Single records, to save, copy or transform rows
  ///@{
  struct Record
  {
    bool with_solid;
    std::uint32_t partner; ///< id of a particle or number of a solid
    Vec3 normal;           ///< with a solid: in its own frame
    const double *history; ///< with particles: oriented from the lower to the higher id
  };
  std::vector<Record> records(std::size_t row) const;
  /// Whether numbers from a file are the records of a row.
  static bool are_records(const double *begin, const double *end, unsigned int n_history);
  void start_row() { rows.starts.push_back(rows.values.size()); }
  void add(const Record &record);
  ///@}

private:
  /// Doubles of a record: kind, partner, then the normal for a solid, then the history.
  std::size_t length(const double *record) const
  {
    return 2 + (record[0] != 0. ? 3 : 0) + n_history;
  }

  unsigned int n_history;
  Rows rows;
};

} // namespace eunoe

#endif
