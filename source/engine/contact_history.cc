#include <eunoe/core/declare.h>
#include <eunoe/engine/contact_history.h>

namespace eunoe {

void ContactHistoryParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, "model parameters");
  declare::enter(prm, "contact history");
  declare::count(prm, "forget interval", forget_interval,
                 "Steps after which contacts lose their memory (slip, rolling, bridges, necks), as "
                 "in programs that lose it at every load balancing: for studies of the "
                 "consequences. 0: never.");
  declare::choice(prm, "forgetful contacts", forgetful, "all|particles|solids",
                  "Which: all, those between particles alone (as Lethe's at a load balancing), or "
                  "those with walls and solids alone.");
  declare::leave(prm);
  declare::leave(prm);
}

} // namespace eunoe
