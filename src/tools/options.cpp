// SPDX-License-Identifier: BSD-3-Clause
#include "tools/options.hpp"

#include <exception>
#include <iostream>

namespace edgevox {
namespace {

namespace po = boost::program_options;

using Texts = std::vector<std::string>;

}  // namespace

int runTool(const std::string& name, int argc, const char* const* argv,
            const std::function<int(const Arguments&)>& tool) {
  try {
    return tool({argv + 1, argv + argc});
  } catch (const std::invalid_argument& error) {
    std::cerr << name << ": " << error.what() << "; see " << name << " --help\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << "\n";
    return 1;
  }
}

po::options_description withHelp(const std::string& usage) {
  po::options_description known(usage);
  known.add_options()("help,h", "print this text");
  return known;
}

std::optional<po::variables_map> parseOptions(const Arguments& arguments,
                                              const po::options_description& known,
                                              const char* positional) {
  return parseOptions(arguments, known, positional == nullptr ? Texts() : Texts{positional});
}

std::optional<po::variables_map> parseOptions(const Arguments& arguments,
                                              const po::options_description& known,
                                              const Texts& positional) {
  po::positional_options_description position;
  for (const std::string& name : positional) position.add(name.c_str(), 1);
  namespace style = po::command_line_style;
  po::variables_map given;
  try {
    po::store(po::command_line_parser(arguments)
                  .options(known)
                  .positional(position)
                  .style(style::unix_style & ~style::allow_guessing)
                  .run(),
              given);
    if (given.count("help") == 0) {
      po::notify(given);
      return given;
    }
  } catch (const po::error& error) {
    throw UsageError(error.what());
  }
  std::cout << known;
  return std::nullopt;
}

std::string textOf(const po::variables_map& given, const char* name) {
  return given.count(name) > 0 ? given[name].as<std::string>() : std::string();
}

Texts textsOf(const po::variables_map& given, const char* name) {
  return given.count(name) > 0 ? given[name].as<Texts>() : Texts();
}

size_t countOf(const po::variables_map& given, const char* name, int64_t least) {
  const auto count = given[name].as<int64_t>();
  if (count >= least) return static_cast<size_t>(count);
  throw UsageError(std::string("--") + name + " must be at least " + std::to_string(least));
}

std::optional<double> numberOf(const po::variables_map& given, const char* name) {
  if (given.count(name) == 0) return std::nullopt;
  return given[name].as<double>();
}

}  // namespace edgevox
