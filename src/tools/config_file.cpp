// SPDX-License-Identifier: BSD-3-Clause
#include "tools/config_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "tools/package_files.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".yaml";

void applyValue(const std::string& name, const std::string& text, Config& config) {
  const std::vector<Parameter> parameters = parametersOf(config);
  for (const Parameter& parameter : parameters) {
    if (parameter.name == name) return assign(parameter, text);
  }
  throw ConfigError("there is no parameter '" + name + "'; did you mean '" +
                    nearestName(parameters, name) + "'?");
}

bool isGroup(const std::string& name) {
  Config config;
  const std::vector<Parameter> parameters = parametersOf(config);
  return std::any_of(parameters.begin(), parameters.end(), [&](const Parameter& p) {
    return p.name.compare(0, name.size() + 1, name + "/") == 0;
  });
}

/// Values of a YAML tree by their full names.
class YamlReader {
 public:
  YamlReader(std::string file, Config& config) : file_(std::move(file)), config_(config) {}

  void read(const YAML::Node& node, const std::string& prefix) {
    for (const auto& entry : node) {
      const std::string name = prefix + keyOf(entry.first);
      if (!seen_.insert(name).second) fail(entry.first, "'" + name + "' is given twice");
      readEntry(name, entry.second, entry.first);
    }
  }

 private:
  std::string keyOf(const YAML::Node& key) const {
    if (!key.IsScalar()) fail(key, "a parameter's name must be a word");
    return key.Scalar();
  }

  void readEntry(const std::string& name, const YAML::Node& value, const YAML::Node& key) {
    if (isGroup(name)) {
      if (value.IsMap()) return read(value, name + "/");
      if (value.IsNull()) return;
      fail(key, "'" + name + "' is a group; its parameters go indented below it");
    }
    try {
      applyValue(name, value.IsScalar() ? value.Scalar() : "", config_);
    } catch (const ConfigError& error) {
      fail(key, error.what());
    }
  }

  [[noreturn]] void fail(const YAML::Node& node, const std::string& text) const {
    throw ConfigError(file_ + ", line " + std::to_string(node.Mark().line + 1) + ": " + text);
  }

  std::string file_;
  Config& config_;
  std::set<std::string> seen_;
};

std::string readText(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in || fs::is_directory(file)) {
    throw ConfigError("cannot read the configuration '" + file.string() +
                      "'; give a preset's name or a YAML file");
  }
  return text.str();
}

std::string presetNames(const std::vector<fs::path>& folders) {
  std::set<std::string> names;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == kExtension) names.insert(entry.path().stem().string());
    }
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "none found" : list;
}

}  // namespace

fs::path findConfigFile(const std::string& name_or_file) {
  const bool is_file = name_or_file.find('/') != std::string::npos ||
                       fs::path(name_or_file).extension() == kExtension;
  if (is_file) return name_or_file;
  const std::vector<fs::path> folders = packageFolders("config");
  for (const fs::path& folder : folders) {
    const fs::path file = folder / (name_or_file + kExtension);
    if (fs::exists(file)) return file;
  }
  throw ConfigError("there is no preset '" + name_or_file + "' (presets: " + presetNames(folders) +
                    "); a file's name needs its extension " + kExtension);
}

void applyYaml(const std::string& text, const std::string& file, Config& config) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ConfigError(file + ", line " + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
  if (root.IsNull()) return;
  if (!root.IsMap()) throw ConfigError(file + ": lines must be 'name: value'");
  YamlReader(file, config).read(root, "");
  try {
    validate(config);
  } catch (const ConfigError& error) {
    throw ConfigError(file + ": " + error.what());
  }
}

void applyConfigFile(const fs::path& file, Config& config) {
  applyYaml(readText(file), file.string(), config);
}

void applySetting(const std::string& setting, Config& config) {
  const size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ConfigError("'" + setting + "' is no setting; write name=value");
  }
  applyValue(setting.substr(0, equals), setting.substr(equals + 1), config);
}

}  // namespace edgevox
