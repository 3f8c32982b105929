#ifndef eunoe_contrib_fuzzing_checkpoint_image_h
#define eunoe_contrib_fuzzing_checkpoint_image_h

#include "checkpoint/format.h"
#include <nlohmann/json.hpp>

#include <cstring>

namespace fuzzing {

/// Makes the file of a checkpoint from the input of a fuzzer, which cannot guess lengths and
/// checksums: the text of the head, a byte 0, and the sections. The sections are cut or filled up
/// to the size that the head promises, unless that is large. A head whose input file is "=" gets
/// @p input. An input that starts like a checkpoint is taken as it is.
inline std::string checkpoint_image(const std::string &data, const std::string &input)
{
  using namespace eunoe::checkpoint_format;
  if (data.rfind(format_name, 0) == 0)
    return data;
  const std::size_t end = std::min(data.find('\0'), data.size());
  std::string head = data.substr(0, end), sections = data.substr(std::min(end + 1, data.size()));
  auto json = nlohmann::ordered_json::parse(head, nullptr, false);
  if (json.is_object() && json.contains("input") && json["input"] == "=") {
    json["input"] = input;
    head = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  }
  if (json.is_object() && json.contains("sections") && json["sections"].is_array()) {
    double bytes = 0.;
    for (const auto &section : json["sections"])
      if (section.is_object() && section.contains("rows") && section.contains("values") &&
          section["rows"].is_number() && section["values"].is_number())
        bytes += 4. * section["rows"].get<double>() + 8. * section["values"].get<double>();
    if (bytes >= 0. && bytes < 1e6)
      sections.resize(static_cast<std::size_t>(bytes), '\0');
  }
  std::string file = format_name + format_version + "\n";
  const auto append = [&file](const auto number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    file.append(bytes, sizeof number);
  };
  append(std::uint64_t(head.size()));
  file += head + sections;
  ChunkChecksums checksums(file.size(), chunk_length);
  checksums.add(0, file.data(), file.size());
  append(checksums.n_bytes);
  for (const std::uint32_t of_chunk : checksums.values)
    append(of_chunk);
  append(checksums.of_all());
  return file;
}

} // namespace fuzzing

#endif
