#ifndef eunoe_discovery_stages_design_h
#define eunoe_discovery_stages_design_h

#include <eunoe/discovery/stages/models.h>

namespace eunoe::discovery {

/// The existing design point that is nearest to a position; the position's own amplitudes if none
/// is near. Near are amplitudes that differ by at most 15 % of the distance from the null value.
Amplitudes nearest_design_point(const StudyState &study, const EffectSet &set,
                                const Eigen::VectorXd &position);

/// The position of the next design point for a fit. That is the fit itself, unless the amplitude of
/// an effect is smaller than all that were run and the effect may be nonlinear there by as much as
/// the data could show. Then it is half of that amplitude, so that the next fit lies between
/// amplitudes that were run: runs at the fit itself would approach a smaller true amplitude without
/// ever reaching it.
Eigen::VectorXd next_design_position(const StudyState &study, const Fit &fit);

/// Squared distance of a fit in the best case: if its effects are nonlinear towards the data as far
/// as the runs so far do not exclude it.
double optimistic_distance(const StudyState &study, const Fit &fit);

} // namespace eunoe::discovery

#endif
