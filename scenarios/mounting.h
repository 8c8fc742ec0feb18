#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "scenarios/catalogue.h"
#include "scenarios/config_reader.h"
#include "scenarios/input_error.h"

/// What the sections of the sensors share: where a sensor sits, which device it is, whether its figures hang together.
namespace plumbline {

/// The six keys of a mounting: where the thing sits, and how it is turned.
Pose read_mounting(ConfigReader& reader, Eigen::Vector3d position);

/// Replaces a model by the catalogue's of that name; returns whether the file names one.
template <typename Model>
bool read_model(ConfigReader& reader, const std::string& kind, Model (*from_catalogue)(const std::string&),
                Model& model) {
  const std::vector<std::string> names = catalogue_names(kind);
  std::size_t index = 0;
  const bool named = reader.read_choice("model", names, index);
  if (named) model = from_catalogue(names[index]);
  return named;
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
