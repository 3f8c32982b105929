// SHA-256 against the examples of FIPS 180-4, and for lengths close to that of a block; of a
// stream, too, which is taken in part by part.

#include <eunoe/core/sha256.h>

#include "../tests.h"

#include <sstream>

EUNOE_TEST()
{
  using namespace test;
  check("empty", sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  check("abc", sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  check("448 bits", sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
                        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  const std::pair<std::size_t, std::string> around_a_block[] = {
      {55, "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318"},
      {56, "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a"},
      {63, "7d3e74a05d7db15bce4ad9ec0658ea98e3f06eeecf16b4c6fff2da457ddc2f34"},
      {64, "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb"},
      {65, "635361c48bb9eab14198e76ea8ab7f1a41685d6ad62aa9146d301d4f17eb0ae0"}};
  for (const auto &[length, digest] : around_a_block)
    check(std::to_string(length) + " bytes", sha256(std::string(length, 'a')) == digest);
  check("one million", sha256(std::string(1000000, 'a')) ==
                           "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  for (const std::size_t length : {0, 3, 64, 65535, 65536, 131072, 1000000}) {
    std::string text(length, 'a');
    if (length > 0)
      text[length / 2] = 'b'; // parts differ
    std::istringstream stream(text);
    check("a stream of " + std::to_string(length) + " bytes", sha256(stream) == sha256(text));
  }
}
