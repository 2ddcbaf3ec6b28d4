// Checking a typed id against its table while the command line is parsed.
#pragma once

#include <span>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tracer/choice.h"

namespace app {

// Refuses what is not the id of a row, and names the known ones. `also` is one more word.
template <class Row>
CLI::Validator one_of(std::span<const Row> rows, const std::string& what,
                      const std::string& also = "") {
  const std::string known = (also.empty() ? "" : also + ", ") + tracer::known_ids(rows);
  return CLI::Validator(
      [rows, what, also, known](const std::string& id) {
        if (tracer::find_row(rows, id) != nullptr || (!also.empty() && id == also)) {
          return std::string();
        }
        return fmt::format("unknown {} '{}'; known: {}", what, id, known);
      },
      "");
}

}  // namespace app
