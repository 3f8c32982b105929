#include <eunoe/core/sha256.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <istream>
#include <vector>

namespace eunoe {

namespace {

/// The first 32 bits of the fractional parts of the cube roots of the first 64 primes.
constexpr std::array<std::uint32_t, 64> constants = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

std::uint32_t rotated(const std::uint32_t x, const unsigned int n)
{
  return x >> n | x << (32 - n);
}

using State = std::array<std::uint32_t, 8>;

void digest_block(const unsigned char *block, State &state)
{
  std::array<std::uint32_t, 64> w;
  for (unsigned int t = 0; t < 16; ++t)
    w[t] = static_cast<std::uint32_t>(block[4 * t]) << 24 |
           static_cast<std::uint32_t>(block[4 * t + 1]) << 16 |
           static_cast<std::uint32_t>(block[4 * t + 2]) << 8 | block[4 * t + 3];
  for (unsigned int t = 16; t < 64; ++t)
    w[t] = w[t - 16] + w[t - 7] +
           (rotated(w[t - 15], 7) ^ rotated(w[t - 15], 18) ^ w[t - 15] >> 3) +
           (rotated(w[t - 2], 17) ^ rotated(w[t - 2], 19) ^ w[t - 2] >> 10);
  State s = state;
  for (unsigned int t = 0; t < 64; ++t) {
    const std::uint32_t choice = (s[4] & s[5]) ^ (~s[4] & s[6]);
    const std::uint32_t majority = (s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]);
    const std::uint32_t first = s[7] + (rotated(s[4], 6) ^ rotated(s[4], 11) ^ rotated(s[4], 25)) +
                                choice + constants[t] + w[t];
    const std::uint32_t second =
        (rotated(s[0], 2) ^ rotated(s[0], 13) ^ rotated(s[0], 22)) + majority;
    s = {first + second, s[0], s[1], s[2], s[3] + first, s[4], s[5], s[6]};
  }
  for (unsigned int k = 0; k < 8; ++k)
    state[k] += s[k];
}

constexpr std::size_t block_size = 64;
constexpr State initial = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                           0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};

/// Takes in as many whole blocks as there are; returns the number of their bytes.
std::size_t digest_blocks(const char *bytes, const std::size_t n, State &state)
{
  std::size_t first = 0;
  for (; first + block_size <= n; first += block_size)
    digest_block(reinterpret_cast<const unsigned char *>(bytes) + first, state);
  return first;
}

/// Takes in what is left behind the last whole block, and gives the digits.
/// @param n_bytes length of all that was taken in
std::string finish(std::string rest, const std::uint64_t n_bytes, State &state)
{
  rest += '\x80';
  rest.append((120 - rest.size() % block_size) % block_size, '\0');
  const std::uint64_t bits = 8 * n_bytes;
  for (int shift = 56; shift >= 0; shift -= 8)
    rest.push_back(static_cast<char>(bits >> shift & 0xff));
  digest_blocks(rest.data(), rest.size(), state);
  std::string digits;
  for (const std::uint32_t word : state) {
    char part[9];
    std::snprintf(part, sizeof part, "%08x", word);
    digits += part;
  }
  return digits;
}

} // namespace

std::string sha256(const std::string &text)
{
  State state = initial;
  const std::size_t whole = digest_blocks(text.data(), text.size(), state);
  return finish(text.substr(whole), text.size(), state);
}

std::string sha256(std::istream &stream)
{
  State state = initial;
  std::vector<char> part(1024 * block_size);
  std::uint64_t n_bytes = 0;
  while (true) {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    const auto n = static_cast<std::size_t>(stream.gcount());
    const std::size_t whole = digest_blocks(part.data(), n, state);
    n_bytes += n;
    if (n < part.size())
      return finish(std::string(part.data() + whole, n - whole), n_bytes, state);
  }
}

} // namespace eunoe
