#include <eunoe/core/declare.h>
#include <eunoe/engine/contact_history.h>

namespace eunoe {

void ContactHistoryParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, "model parameters");
  declare::enter(prm, "contact history");
  declare::count(prm, "forget interval", forget_interval,
                 "Steps after which every contact loses its memory (slip, rolling, bridges), as "
                 "in programs that lose it at every load balancing: for studies of the "
                 "consequences. 0: never.");
  declare::leave(prm);
  declare::leave(prm);
}

} // namespace eunoe
