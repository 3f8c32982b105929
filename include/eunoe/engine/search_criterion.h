#ifndef eunoe_engine_search_criterion_h
#define eunoe_engine_search_criterion_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/engine/moving_solids.h>
#include <eunoe/state/particle_arrays.h>

#include <algorithm>
#include <optional>

namespace eunoe {

/// When contacts are searched and how far: `subsection contact detection`.
struct ContactDetectionParameters : public ParameterSection
{
  std::string method = "dynamic"; ///< constant or dynamic
  unsigned int frequency = 1;
  double displacement_share = 0.8; ///< "dynamic contact search size coefficient"
  /// With which `auto` begins.
  static constexpr double first_threshold = 1.3;
  /// Reach of the search over the largest diameter; none: `auto`.
  std::optional<double> neighborhood_threshold = first_threshold;

  /// Separation up to which the search lists pairs (m), for particles of at most
  /// @p largest_diameter; of `auto` that with which it begins.
  double skin(double largest_diameter) const
  {
    return (neighborhood_threshold.value_or(first_threshold) - 1.) * largest_diameter;
  }

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
};

/// Decides when two bodies may have come closer than the skin allows, so that contacts must be
/// searched. The ranks exchange their displacements while they do something else.
class SearchCriterion
{
public:
  /// @param skin separation up to which pairs are listed (m)
  SearchCriterion(const ContactDetectionParameters &parameters, double skin, MPI_Comm comm);
  ~SearchCriterion();
  SearchCriterion(const SearchCriterion &) = delete;
  SearchCriterion &operator=(const SearchCriterion &) = delete;

  /// From the next search on pairs are listed up to another separation (m).
  void set_skin(double separation);

  /// Largest sum of the displacements of two bodies before the next search (m).
  double allowed_displacement() const { return allowed; }

  /// How far a particle may have gone from its reference without a search (m): two bodies must not
  /// come closer by more than the skin. Between the searches of "constant" nobody looks at the
  /// second farthest, so each may move by half of it.
  double longest_way() const { return parameters.method == "constant" ? 0.5 * skin : skin; }

  /// Asks how far particles have gone on any rank; collective.
  /// @param travel on this rank
  /// @param near_share of this rank, see `NearPairs`
  void ask(unsigned long long step, const Travel &travel, double near_share);

  /// Of a particle from its reference, on any rank, once all have answered (m); infinite if it is
  /// not known.
  double largest_displacement() const { return largest.displacements.first; }
  /// In this step, likewise: of a particle over its pace, and the typical step (m), which is the
  /// root of the largest mean square of a rank.
  double largest_paces() const { return largest.paces; }
  double typical_step() const { return largest.typical_step; }
  /// The largest of all ranks' shares; this rank's where nothing was asked.
  double largest_near_share() const { return largest.near_share; }

  /// Whether a search is due, once all ranks have answered; collective.
  /// @param solids which have moved, too
  bool is_due(const MovingSolids &solids);

private:
  /// On any rank.
  struct Largest
  {
    TwoLargest displacements;   ///< of two particles from their references (m)
    double paces, typical_step; ///< in this step (paces, m)
    double near_share;
  };
  /// Brings what two parts of the ranks have found together, as MPI asks for it. The second
  /// farthest of all may be on any rank, also beside the farthest, so no maximum finds it.
  static void combine(void *one, void *both, int *n, MPI_Datatype *);

  const ContactDetectionParameters &parameters;
  double skin, allowed;
  MPI_Comm comm;
  MPI_Datatype type; ///< a Largest as one piece, which MPI does not divide
  MPI_Op operation;
  Largest largest = {};
  MPI_Request answer = MPI_REQUEST_NULL;
};

} // namespace eunoe

#endif
