#ifndef eunoe_core_plugin_section_h
#define eunoe_core_plugin_section_h

#include <eunoe/core/parameter_section.h>

#include <memory>

namespace eunoe {

/// What the input says of a plug-in, in entries that the plug-in's own file declares. The registry
/// of a kind of plug-ins makes the sections; a section makes the plug-in.
///
/// Subsections of the input can be entered again, so entries of many files may share one.
template <typename Plugin, typename... Arguments>
class PluginSection : public ParameterSection
{
public:
  void declare(dealii::ParameterHandler &) override {}

  /// Null where the input does not ask for the plug-in.
  virtual std::unique_ptr<Plugin> make(Arguments... arguments) const = 0;

  /// The section of a kind of plug-in without entries of its own.
  template <typename Kind>
  static std::unique_ptr<PluginSection> without_entries();
};

template <typename Plugin, typename... Arguments>
template <typename Kind>
std::unique_ptr<PluginSection<Plugin, Arguments...>> PluginSection<Plugin,
                                                                   Arguments...>::without_entries()
{
  struct Section : public PluginSection
  {
    std::unique_ptr<Plugin> make(Arguments... arguments) const override
    {
      return std::make_unique<Kind>(arguments...);
    }
  };
  return std::make_unique<Section>();
}

} // namespace eunoe

#endif
