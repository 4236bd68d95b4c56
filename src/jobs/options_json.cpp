#include "evenmesh/options_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "evenmesh/error.h"
#include "evenmesh/names.h"
#include "shape/suggestions.h"

namespace evenmesh {
namespace {

using Json = nlohmann::ordered_json;

/// A member of MeshOptions in JSON.
struct Option {
  std::string_view key;
  /// Leaves out what is not set.
  std::function<void(const MeshOptions&, Json&)> write;
  std::function<void(const Json&, MeshOptions&)> read;
};

std::string brief(const Json& value) {
  constexpr std::size_t longest = 40;
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= longest ? text : text.substr(0, longest) + " …";
}

[[noreturn]] void refuse(std::string_view key, const std::string& wanted, const Json& value) {
  throw InvalidInput(fmt::format("the option {} takes {}, not {}", key, wanted, brief(value)));
}

template <typename Member>
struct Unwrapped {
  using type = Member;
};
template <typename Value>
struct Unwrapped<std::optional<Value>> {
  using type = Value;
};

/// The value of a member that is set.
template <typename Value>
const Value* set_value(const Value& member) {
  return &member;
}
template <typename Value>
const Value* set_value(const std::optional<Value>& member) {
  return member ? &*member : nullptr;
}

template <typename Member, typename Read>
Option member_option(std::string_view key, Member MeshOptions::*member, Read read) {
  return {key,
          [key, member](const MeshOptions& options, Json& json) {
            if (const auto* value = set_value(options.*member)) json[std::string(key)] = *value;
          },
          [member, read](const Json& value, MeshOptions& options) { options.*member = read(value); }};
}

template <typename Member, typename Number = typename Unwrapped<Member>::type>
Option whole_number(std::string_view key, Member MeshOptions::*member, Range<Number> range) {
  return member_option(key, member, [key, range](const Json& value) {
    const bool whole = value.is_number_unsigned();
    const auto number = whole ? value.get<std::uint64_t>() : 0;
    if (!whole || number < range.lo || number > range.hi)
      refuse(key, fmt::format("a whole number from {} to {}", range.lo, range.hi), value);
    return static_cast<Number>(number);
  });
}

template <typename Member>
Option number(std::string_view key, Member MeshOptions::*member) {
  return member_option(key, member, [key](const Json& value) {
    if (!value.is_number()) refuse(key, "a number", value);
    return value.get<double>();
  });
}

Option yes_or_no(std::string_view key, bool MeshOptions::*member) {
  return member_option(key, member, [key](const Json& value) {
    if (!value.is_boolean()) refuse(key, "true or false", value);
    return value.get<bool>();
  });
}

template <typename Enum>
std::string suggestion(std::string_view name) {
  std::vector<std::string_view> candidates;
  for (const Named<Enum>& entry : names<Enum>()) candidates.push_back(entry.name);
  return did_you_mean(name, candidates);
}

template <typename Enum>
Option choice(std::string_view key, Enum MeshOptions::*member) {
  return {key,
          [key, member](const MeshOptions& options, Json& json) { json[std::string(key)] = name_of(options.*member); },
          [key, member](const Json& value, MeshOptions& options) {
            const std::string wanted = "one of " + joined_names<Enum>();
            if (!value.is_string()) refuse(key, wanted, value);
            const auto name = value.get<std::string>();
            const std::optional<Enum> found = value_of<Enum>(name);
            if (!found)
              throw InvalidInput(
                  fmt::format("the option {} takes {}, not {}{}", key, wanted, brief(value), suggestion<Enum>(name)));
            options.*member = *found;
          }};
}

Option features() {
  return {"features",
          [](const MeshOptions& options, Json& json) {
            if (options.feature_angle) {
              json["features"] = *options.feature_angle;
            } else {
              json["features"] = "off";
            }
          },
          [](const Json& value, MeshOptions& options) {
            if (value == "auto") {
              options.feature_angle = MeshOptions{}.feature_angle;
            } else if (value == "off") {
              options.feature_angle.reset();
            } else if (value.is_number()) {
              options.feature_angle = value.get<double>();
            } else {
              refuse("features", "an angle in degrees, \"auto\" or \"off\"", value);
            }
          }};
}

Option bounds() {
  return {"bounds",
          [](const MeshOptions& options, Json& json) {
            if (!options.bounds) return;
            const auto& [lo, hi] = *options.bounds;
            json["bounds"] = {lo.x, lo.y, lo.z, hi.x, hi.y, hi.z};
          },
          [](const Json& value, MeshOptions& options) {
            const auto is_number = [](const Json& item) { return item.is_number(); };
            if (!value.is_array() || value.size() != 6 || !std::all_of(value.begin(), value.end(), is_number))
              refuse("bounds", "six numbers [x0, y0, z0, x1, y1, z1]", value);
            const auto at = [&](std::size_t i) { return value[i].get<double>(); };
            Box box;
            box.lo = {at(0), at(1), at(2)};
            box.hi = {at(3), at(4), at(5)};
            options.bounds = box;
          }};
}

void write_density(const MeshOptions& options, Json& json) {
  if (!options.density) {
    json["density"] = "uniform";
    return;
  }
  const std::optional<DensityExpression> made_of = expression_of(options.density);
  json["density"] = nullptr;
  if (!made_of) return;
  json["density"] = made_of->expression;
  if (!made_of->parameters.empty()) json["density_parameters"] = made_of->parameters;
}

/// Both keys at once; either may be missing, and then stays as it is.
void read_density(const Json& json, MeshOptions& options) {
  if (!json.contains("density") && !json.contains("density_parameters")) return;
  DensityExpression wanted = expression_of(options.density).value_or(DensityExpression{});
  if (json.contains("density")) {
    const Json& text = json["density"];
    if (!text.is_string()) refuse("density", "\"uniform\" or an expression in x, y, z", text);
    wanted = {text.get<std::string>()};
  }
  if (json.contains("density_parameters")) {
    const Json& parameters = json["density_parameters"];
    if (!parameters.is_object()) refuse("density_parameters", "an object of numbers by name", parameters);
    wanted.parameters.clear();
    for (const auto& [name, value] : parameters.items()) {
      if (!value.is_number()) refuse("density_parameters." + name, "a number", value);
      wanted.parameters[name] = value.get<double>();
    }
  }
  if (wanted.expression.empty() && !json.contains("density"))
    throw InvalidInput("the option density_parameters is for a density; give density, too");
  if (wanted.expression == "uniform") {
    options.density = {};
    return;
  }
  try {
    options.density = density_from_expression(wanted.expression, wanted.parameters);
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("the option density: {}", error.what()));
  }
}

/// All but the density, in the order of the struct.
const std::vector<Option>& all_options() {
  using O = MeshOptions;
  static const std::vector<Option> all{
      whole_number("vertices", &O::vertices, ranges::vertices),
      number("edge_length", &O::edge_length),
      whole_number("resolution", &O::resolution, ranges::resolution),
      choice("method", &O::method),
      whole_number("thickness", &O::thickness, ranges::thickness),
      features(),
      yes_or_no("fill_cavities", &O::fill_cavities),
      yes_or_no("wrap", &O::wrap),
      bounds(),
      choice("quality", &O::quality),
      number("evenness", &O::evenness),
      choice("optimizer", &O::optimizer),
      choice("start", &O::start),
      choice("connect", &O::connect),
      whole_number("max_cycle", &O::max_cycle, ranges::max_cycle),
      choice("topology", &O::topology),
      choice("placement", &O::placement),
      whole_number("iterations", &O::iterations, ranges::iterations),
      number("tolerance", &O::tolerance),
      whole_number("seed", &O::seed, Range<std::uint64_t>{0, std::numeric_limits<std::uint64_t>::max()}),
  };
  return all;
}

void read_option(const std::string& key, const Json& value, MeshOptions& options) {
  if (key == "density" || key == "density_parameters") return;
  std::vector<std::string_view> known{"density", "density_parameters"};
  for (const Option& option : all_options()) {
    if (option.key == key) return option.read(value, options);
    known.push_back(option.key);
  }
  throw InvalidInput(fmt::format("there is no option {}{}", brief(key), did_you_mean(key, known)));
}

Json parse_object(std::string_view text) {
  try {
    Json json = Json::parse(text);
    if (json.is_object()) return json;
  } catch (const Json::parse_error& error) {
    throw InvalidInput(fmt::format("the options are no JSON: wrong at byte {}", error.byte));
  } catch (const Json::exception&) {
    throw InvalidInput("the options are no JSON: a number is too large");
  }
  throw InvalidInput("the options must be one JSON object, such as {\"vertices\": 5000}");
}

}  // namespace

std::string options_json(const MeshOptions& options) {
  Json json = Json::object();
  for (const Option& option : all_options()) option.write(options, json);
  write_density(options, json);
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

MeshOptions options_from_json(std::string_view text, const MeshOptions& base) {
  const Json json = parse_object(text);
  MeshOptions options = base;
  for (const auto& [key, value] : json.items()) read_option(key, value, options);
  read_density(json, options);
  return options;
}

}  // namespace evenmesh
