// Build options in words, from the fields that sessions keep.
#include <algorithm>

#include <fmt/format.h>

#include "tracer/analyze/comparison.h"
#include "tracer/session_fields.h"

namespace tracer {
namespace {

// An archive (session_fields.h) that writes each field down.
struct Fields {
  struct Field {
    std::string name, value;
    bool choice = false;
  };
  std::vector<Field> all;

  template <class Value>
  void number(std::string_view name, Value& value, Value, Value) {
    add(name, fmt::format("{}", value));
  }
  void flag(std::string_view name, bool value) { add(name, value ? "on" : "off"); }
  template <class Row>
  void choice(std::string_view name, const std::string& id, std::span<const Row>) {
    add(name, id);
    all.back().choice = true;
  }

 private:
  void add(std::string_view name, std::string value) {
    std::string words(name);
    std::replace(words.begin(), words.end(), '_', ' ');
    all.push_back({words, std::move(value)});
  }
};

Fields fields_of(BuildOptions options) {
  Fields fields;
  session_fields(fields, options);
  return fields;
}

}  // namespace

std::string describe(const BuildOptions& options) {
  const Fields fields = fields_of(options);
  const Fields usual = fields_of({});
  std::string text;
  for (size_t i = 0; i < fields.all.size(); ++i) {
    const Fields::Field& field = fields.all[i];
    const bool first = i == 0;  // the builder
    if (!first && field.value == usual.all[i].value) continue;
    if (first) {
      text = field.value;
    } else if (field.choice && field.name != "occlusion order") {
      text += " + " + field.value;
    } else {
      text += fmt::format(", {} {}", field.name, field.value);
    }
  }
  return text;
}

}  // namespace tracer
