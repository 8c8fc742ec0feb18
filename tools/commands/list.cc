#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>

#include "estimator/estimator.h"
#include "scenarios/catalogue.h"
#include "sim/scene_library.h"
#include "sim/vehicles/vehicle.h"
#include "tools/commands/command.h"
#include "tools/exit_code.h"
#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

void print_row(const std::string& name, const std::string& summary, std::size_t width) {
  std::cout << name << std::string(width > name.size() ? width - name.size() : 1, ' ') << summary << "\n";
}

/// A scenario file introduces itself by its first comment.
std::string first_comment(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line) || line.empty() || line.front() != '#') return {};
  return line.substr(std::min(line.find_first_not_of("# "), line.size()));
}

/// A folder installed beside the program, or the one in the source tree.
fs::path library_folder(const char* installed, const char* in_source_tree) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  for (const fs::path& candidate :
       {program.parent_path() / "../share/plumbline" / installed, fs::path(in_source_tree)}) {
    if (fs::is_directory(candidate, error)) return candidate;
  }
  return {};
}

void list_scenarios() {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(library_folder("scenarios", PLUMBLINE_SCENARIO_DIR), error)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::size_t width = 0;
  for (const fs::path& file : files) width = std::max(width, file.string().size() + 2);
  for (const fs::path& file : files) print_row(file.string(), first_comment(file), width);
}

void list_sensors() {
  for (const CatalogueEntry& entry : sensor_catalogue()) print_row(entry.name, entry.kind + ": " + entry.summary, 18);
}

void list_estimators() {
  for (const EstimatorInfo& info : estimator_library()) print_row(info.name, info.summary, 24);
  print_row("exec:PROGRAM ARGUMENTS", "a program that reads messages and writes poses; see tools/outside/README.md",
            24);
  print_row("LIBRARY.so", "a shared library that exports plumbline_make_estimator", 24);
}

void list_scenes() {
  const fs::path pictures = library_folder("pictures", PLUMBLINE_PICTURE_DIR);
  for (const SceneInfo& scene : scene_library()) {
    print_row(scene.name, scene.summary, 18);
    print_row("  picture", (pictures / (scene.name + ".jpg")).string(), 26);
    for (const SceneParameter& parameter : scene.parameters) {
      print_row("  " + parameter.name,
                readable_text(parameter.default_value) + " (" + readable_text(parameter.min) + " … " +
                    readable_text(parameter.max) + ")  " + parameter.meaning,
                26);
    }
  }
}

void list_vehicles() {
  for (const VehicleInfo& vehicle : vehicle_library()) print_row(vehicle.name, vehicle.summary, 12);
}

const std::map<std::string, void (*)()> kLists = {{"scenarios", list_scenarios},
                                                  {"sensors", list_sensors},
                                                  {"estimators", list_estimators},
                                                  {"scenes", list_scenes},
                                                  {"vehicles", list_vehicles}};

}  // namespace

void add_list_command(CLI::App& app, Action& chosen) {
  const auto what = std::make_shared<std::string>();
  CLI::App* list = app.add_subcommand("list", "Show what there is to choose from");
  list->add_option("WHAT", *what, "scenarios, sensors, estimators, scenes or vehicles")
      ->required()
      ->check(CLI::IsMember({"scenarios", "sensors", "estimators", "scenes", "vehicles"}));
  list->callback([what, &chosen] {
    chosen = [what] {
      kLists.at (*what)();
      return static_cast<int>(kExitDone);
    };
  });
}

}  // namespace plumbline
