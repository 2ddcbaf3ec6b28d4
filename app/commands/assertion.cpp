// Parsing conditions and holding them against a report.
#include "app/commands/assertion.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "app/commands/command.h"

namespace app {
namespace {

using tracer::Json;

std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

bool holds(double value, std::string_view comparison, double limit) {
  if (comparison == "<") return value < limit;
  if (comparison == "<=") return value <= limit;
  if (comparison == ">") return value > limit;
  if (comparison == ">=") return value >= limit;
  if (comparison == "==") return value == limit;
  return value != limit;
}

// The number at "rays.primary.count" below `object`, or nullptr.
const Json* number_at(const Json& object, const std::string& field) {
  std::string path = "/" + field;
  std::replace(path.begin(), path.end(), '.', '/');
  const Json::json_pointer pointer(path);
  if (!object.contains(pointer)) return nullptr;
  const Json& value = object.at(pointer);
  return value.is_number() ? &value : nullptr;
}

// "nodes, leaves, sah".
std::string numbers_of(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [name, value] : object.items()) {
    if (value.is_number()) names.push_back(name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

Assertion parse_assertion(std::string_view text) {
  const size_t begin = text.find_first_of("<>=!");
  const size_t end = text.find_first_not_of("<>=!", begin);
  if (begin != std::string_view::npos && end != std::string_view::npos) {
    Assertion assertion{std::string(text), std::string(trimmed(text.substr(0, begin))),
                        std::string(text.substr(begin, end - begin)), 0.0};
    const std::string_view number = trimmed(text.substr(end));
    const auto [rest, error] =
        std::from_chars(number.data(), number.data() + number.size(), assertion.limit);
    const std::string_view known[] = {"<", "<=", ">", ">=", "==", "!="};
    const bool compares =
        std::find(std::begin(known), std::end(known), assertion.comparison) != std::end(known);
    const bool plain = assertion.field.find_first_not_of(
                           "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.") ==
                       std::string::npos;
    if (compares && plain && !assertion.field.empty() && error == std::errc() &&
        std::isfinite(assertion.limit) && rest == number.data() + number.size()) {
      return assertion;
    }
  }
  throw UsageError(fmt::format(
      "--assert: '{}' is not a condition; write FIELD<NUMBER with one of < <= > >= == !=, as in "
      "'sah<40' or 'rays.primary.nodes.mean<=30'",
      text));
}

std::string failures(const Assertion& assertion, const Json& report) {
  const auto failure = [&](const Json& value, const std::string& where) {
    if (holds(value.get<double>(), assertion.comparison, assertion.limit)) return std::string();
    return fmt::format("{}: {} is {}, not {} {}\n", where, assertion.field, value.dump(),
                       assertion.comparison, assertion.limit);
  };
  if (const Json* value = number_at(report, assertion.field)) return failure(*value, "report");
  std::string all;
  for (const Json& build : report.at("builds")) {
    const Json* value = number_at(build, assertion.field);
    if (value == nullptr) {
      throw UsageError(
          fmt::format("--assert: the report has no number '{}'; it has {}, and in other objects of "
                      "--json those "
                      "with dots between the levels, as in rays.primary.nodes.mean",
                      assertion.field, numbers_of(build)));
    }
    all += failure(*value, build.at("builder").get<std::string>());
  }
  return all;
}

}  // namespace app
