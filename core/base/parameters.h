// Declares parameters of techniques. Each is declared once; the declaration yields the command-line flag
// (--set technique.name=value), the TOML key of a bench suite, the sweep axis, the widget, the `limn list`
// entry and the generated documentation.
//
//     constexpr limn::Parameter kParameters[] = {
//         limn::integer("shadow_map_size", 1024, {16, 16384}, "texels", "Width and height of the shadow map")
//             .quality(),
//         limn::real("bias", 1.5, {0, 64}, "texel footprints", "Depth offset against self-shadowing"),
//         limn::choice("pattern", 0, patterns, "Where the samples lie"),
//     };
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/export.h"

namespace limn {

enum class ParameterType : uint8_t { boolean, integer, real, choice };

struct ParameterRange {
  double low, high;  ///< inclusive
};

struct Parameter {
  const char* name;
  ParameterType type;
  double defaultValue;  ///< choice: the index of the default
  ParameterRange range;
  const char* unit;  ///< "" for pure numbers
  const char* doc;   ///< one line
  const char* const* choices = nullptr;
  int choiceCount = 0;
  bool tradesErrorForTime = false;  ///< a sweep axis of the bench
  bool logarithmic = false;         ///< sweeps and sliders step by factors
  /// If not null, the parameter lets the technique leave out work that does not affect the result, and this
  /// value forces that work to be done (core/bench/savings.h).
  const char* forcing = nullptr;
  /// Says whether, set to another value than the default, pictures depend on how long frames take.
  bool followsClock = false;

  constexpr Parameter quality() const {
    Parameter p = *this;
    p.tradesErrorForTime = true;
    return p;
  }
  constexpr Parameter logScale() const {
    Parameter p = *this;
    p.logarithmic = true;
    return p;
  }
  constexpr Parameter savesWork(const char* forcingValue) const {
    Parameter p = *this;
    p.forcing = forcingValue;
    return p;
  }
  constexpr Parameter byClock() const {
    Parameter p = *this;
    p.followsClock = true;
    return p;
  }
};

constexpr Parameter boolean(const char* name, bool value, const char* doc) {
  return {name, ParameterType::boolean, value ? 1.0 : 0.0, {0, 1}, "", doc};
}
constexpr Parameter integer(const char* name, int value, ParameterRange range, const char* unit,
                            const char* doc) {
  return {name, ParameterType::integer, static_cast<double>(value), range, unit, doc};
}
constexpr Parameter real(const char* name, double value, ParameterRange range, const char* unit,
                         const char* doc) {
  return {name, ParameterType::real, value, range, unit, doc};
}
template <size_t N>
constexpr Parameter choice(const char* name, int value, const char* const (&names)[N], const char* doc) {
  return {name,  ParameterType::choice, static_cast<double>(value), {0, static_cast<double>(N - 1)}, "", doc,
          names, static_cast<int>(N)};
}

/// Holds the values of one technique's parameters, which are the defaults until they are set. Asking for an
/// undeclared name or for another type is a bug and throws std::logic_error.
class LIMN_API ParameterValues {
 public:
  ParameterValues() = default;
  ParameterValues(std::string technique, std::span<const Parameter> declared);

  /// Returns whether a parameter of that name was declared.
  bool has(std::string_view name) const { return find(name) < declared_.size(); }

  bool boolean(std::string_view name) const;
  int integer(std::string_view name) const;
  float real(std::string_view name) const;
  int choice(std::string_view name) const;

  /// Parses, checks and stores a value. Throws UsageError naming technique, parameter, value and what is
  /// accepted; for an unknown name, the message lists the nearest known names.
  void set(std::string_view name, std::string_view text);

  std::span<const Parameter> declared() const { return declared_; }
  /// Returns the name and the printed value of every parameter, in declaration order.
  std::vector<std::pair<std::string, std::string>> printed() const;

 private:
  size_t find(std::string_view name) const;
  double value(std::string_view name, ParameterType type) const;
  std::string technique_;
  std::span<const Parameter> declared_;
  std::vector<double> values_;
};

}  // namespace limn
