#include <eunoe/core/random.h>

namespace eunoe {

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key)
{
  for (unsigned int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t(0xD2511F53u) * counter[0];
    const std::uint64_t b = std::uint64_t(0xCD9E8D57u) * counter[2];
    counter = {
        {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
         static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)}};
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
  return counter;
}

double uniform(const std::uint32_t seed, const Draw purpose, const std::uint64_t id,
               const std::uint32_t index)
{
  const auto bits =
      philox({{static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(id >> 32), index, 0}},
             {{seed, static_cast<std::uint32_t>(purpose)}});
  const std::uint64_t high = (std::uint64_t(bits[0]) << 32 | bits[1]) >> 11;
  return static_cast<double>(high) * 0x1p-53;
}

} // namespace eunoe
