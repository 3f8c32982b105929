#ifndef eunoe_core_registry_h
#define eunoe_core_registry_h

#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace eunoe {

/// Plug-ins of one kind by name. A plug-in's file holds one static `Registration`.
template <typename Product, typename... Arguments>
class Registry
{
public:
  using Maker = std::function<Product(Arguments...)>;

  struct Registration
  {
    Registration(Registry &registry, const std::string &name, Maker maker)
    {
      registry.makers[name] = std::move(maker);
    }
  };

  bool has(const std::string &name) const { return makers.count(name) > 0; }

  Product make(const std::string &name, Arguments... arguments) const
  {
    const auto maker = makers.find(name);
    if (maker == makers.end())
      throw std::invalid_argument("there is no '" + name + "' among " + names());
    return maker->second(std::forward<Arguments>(arguments)...);
  }

  /// All names, in alphabetical order.
  std::vector<std::string> list() const
  {
    std::vector<std::string> all;
    for (const auto &entry : makers)
      all.push_back(entry.first);
    return all;
  }

  /// All names as "a|b|c", the pattern of a selection in an input file.
  std::string names() const
  {
    std::string all;
    for (const auto &entry : makers)
      all += (all.empty() ? "" : "|") + entry.first;
    return all;
  }

private:
  std::map<std::string, Maker> makers;
};

} // namespace eunoe

#endif
