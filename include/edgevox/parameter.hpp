// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace edgevox {

/// A parameter that is one of a few words.
struct Choice {
  std::vector<std::string> words;
  std::function<std::string()> get;
  std::function<bool(const std::string&)> set;  ///< false if it is none of the words
};

/// One parameter of a struct, by reference. A list of them is the only place where names are
/// written: files, ROS parameters and documentation are made from it.
struct Parameter {
  std::string name;  ///< "group/name" or "name"
  std::variant<double*, int*, bool*, std::string*, Choice> value;
  double min = 0.0;  ///< of a number
  double max = 0.0;
  std::string unit;
  std::string meaning;
  std::string former_name{};  ///< not known any more, for nearestName(); or empty
};

struct ConfigError : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Throws ConfigError if the text is no value of the parameter's type and range.
void assign(const Parameter& parameter, const std::string& text);

/// Throws ConfigError if a number is out of its range.
void checkRange(const Parameter& parameter);

/// The shortest text that assign() turns back into the same value.
std::string valueText(const Parameter& parameter);

/// For "did you mean": the name of the parameter that was called `name`, else the one most like it
/// in the list, which must not be empty.
std::string nearestName(const std::vector<Parameter>& parameters, const std::string& name);

}  // namespace edgevox
