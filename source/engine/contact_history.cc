#include <eunoe/core/declare.h>
#include <eunoe/engine/contact_history.h>

namespace eunoe {

void ContactHistoryParameters::declare(dealii::ParameterHandler &prm)
{
  prm.enter_subsection("model parameters");
  prm.enter_subsection("contact history");
  declare::count(prm, "forget interval", forget_interval,
                 "Steps after which every contact loses its memory (slip, rolling, bridges), as "
                 "in programs that lose it at every load balancing: for studies of the "
                 "consequences. 0: never.");
  prm.leave_subsection();
  prm.leave_subsection();
}

} // namespace eunoe
