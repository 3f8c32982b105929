#ifndef eunoe_discovery_stages_places_h
#define eunoe_discovery_stages_places_h

#include <eunoe/discovery/stages/models.h>

namespace eunoe::discovery {

/// Amplitudes at which more runs tell most: those of the nearest runs, or where none are near,
/// those of the position itself. Near is what differs by at most 15 % of the distance from the null
/// value.
Amplitudes near_amplitudes(const Workbench &bench, const EffectSet &set,
                           const Eigen::VectorXd &position);

/// Where runs teach most about a fit. That is the fit itself, unless an effect lies before the
/// first amplitude that was run, and may bend there by as much as the data could tell: then half
/// way to nothing, so that the next fit lies between amplitudes that were run. Runs at the fit
/// itself would draw nearer and nearer to a truth on one side of them without ever reaching it.
Eigen::VectorXd place_of_runs(const Workbench &bench, const Fit &fit);

/// Squared distance that would be left of a fit if its effects, as far as they may bend unseen,
/// bent towards the data.
double hoped_distance(const Workbench &bench, const Fit &fit);

} // namespace eunoe::discovery

#endif
