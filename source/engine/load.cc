#include <eunoe/engine/load.h>

namespace eunoe {

LoadRegistry &loads()
{
  static LoadRegistry registry("load");
  return registry;
}

} // namespace eunoe
