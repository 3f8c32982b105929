#ifndef eunoe_engine_contact_history_h
#define eunoe_engine_contact_history_h

#include <eunoe/core/parameter_section.h>

namespace eunoe {

/// When contacts lose what they remember, for studies of forgetting: `subsection contact history`.
struct ContactHistoryParameters : public ParameterSection
{
  unsigned long long forget_interval = 0; ///< steps; 0: never
  std::string forgetful = "all";

  bool between_particles() const { return forgetful != "solids"; }
  bool with_solids() const { return forgetful != "particles"; }
  bool forgets_at(unsigned long long step) const
  {
    return forget_interval > 0 && step % forget_interval == 0;
  }

  void declare(dealii::ParameterHandler &prm) override;
};

} // namespace eunoe

#endif
