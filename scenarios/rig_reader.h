#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "scenarios/catalogue.h"
#include "scenarios/config_reader.h"
#include "scenarios/input_error.h"

/// What the sections of the rig's sensors have in common.
namespace plumbline {

/// Replaces a model by the catalogue's of that name.
template <typename Model>
void read_model(ConfigReader& reader, const std::string& kind, Model (*from_catalogue)(const std::string&),
                Model& model) {
  const std::vector<std::string> names = catalogue_names(kind);
  std::size_t index = 0;
  if (reader.read_choice("model", names, index)) model = from_catalogue(names[index]);
}

/// The model's own rules, which know how its figures hang together.
template <typename Model>
void check_model(const ConfigReader& reader, const Model& model) {
  try {
    validate_or_throw(model);
  } catch (const std::invalid_argument& error) {
    throw InputError(reader.node().where + ": " + reader.path() + ": " + error.what());
  }
}

}  // namespace plumbline
