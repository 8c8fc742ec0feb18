#include "tools/lab/lab_table.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <numbers>

#include "tools/evaluation/figures.h"
#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

constexpr int kTableDigits = 9;
constexpr const char* kMitigationsHeader = "mitigation,drift_percent,progress_ratio,degenerate\n";
constexpr std::size_t kColumns = 1 + 6 + 2 + 2 * kDetectors.size() + 2;

std::string header() {
  std::string text = "stamp_ns";
  for (int i = 1; i <= 6; ++i) text += ",excess_" + std::to_string(i);
  text += ",degenerate,mean_range_m";
  for (const Detector detector : kDetectors) {
    const std::string name(to_string(detector));
    text += "," + name + "," + name + "_angle_deg";
  }
  return text + ",error_over_selected,error_over_all\n";
}

void append(std::string& text, const std::optional<double>& value, double unit = 1.0) {
  text += ',';
  if (value) append_general(text, *value * unit, kTableDigits);
}

/// Cells of a line; an empty one is nothing. @returns fewer than all if one is no number
std::vector<std::optional<double>> cells_of(const std::string& line) {
  std::vector<std::optional<double>> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    if (begin == end) {
      cells.emplace_back();
    } else {
      double value = 0.0;
      const auto [stop, error] = std::from_chars(line.data() + begin, line.data() + end, value);
      if (error != std::errc() || stop != line.data() + end) return {};
      cells.emplace_back(value);
    }
    begin = end + 1;
  }
  return cells;
}

}  // namespace

std::string lab_csv(const std::vector<ScanTrial>& trials) {
  std::string text = header();
  for (const ScanTrial& trial : trials) {
    text += std::to_string(trial.stamp_ns);
    for (int i = 0; i < 6; ++i) append(text, trial.label.excess[i]);
    (text += ',') += std::to_string(trial.label.degenerate());
    append(text, trial.mean_range_m);
    for (const DetectorReading& reading : trial.detectors) {
      append(text, reading.score);
      append(text, reading.angle_rad, 180.0 / std::numbers::pi);
    }
    append(text, trial.error_over_selected);
    append(text, trial.error_over_all);
    text += '\n';
  }
  return text;
}

std::string truth_csv(const std::vector<ScanTrial>& scans, const std::vector<ImageTrial>& images) {
  std::string text = "stamp_ns,module,features,degenerate";
  for (int i = 1; i <= 6; ++i) text += ",excess_" + std::to_string(i);
  text += '\n';
  const auto add = [&](std::int64_t stamp_ns, const std::string& module, const DegeneracyLabel& label) {
    text += std::to_string(stamp_ns) + module + std::to_string(label.degenerate());
    for (int i = 0; i < 6; ++i) append(text, label.excess[i]);
    text += '\n';
  };
  for (const ScanTrial& scan : scans) add(scan.stamp_ns, ",lidar,,", scan.label);
  for (const ImageTrial& image : images) {
    add(image.stamp_ns, ",vision," + std::to_string(image.features) + ",", image.label);
  }
  return text;
}

std::string mitigations_csv(const LabRun& lab) {
  const auto degenerate = std::count_if(lab.scans.begin(), lab.scans.end(), [](const ScanTrial& scan) {
    return scan.label.worst() == DegeneracyLabel::Class::kDegenerate;
  });
  std::string text = kMitigationsHeader;
  for (std::size_t i = 0; i < kMitigations.size(); ++i) {
    const TrajectoryFigures figures = trajectory_figures(lab.truth, lab.estimates[i]);
    text += to_string(kMitigations[i]);
    append(text, figures.drift_percent);
    append(text, figures.progress.whole);
    (text += ',') += std::to_string(degenerate);
    text += '\n';
  }
  return text;
}

std::vector<MitigationRow> read_mitigations_csv(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line) || line + "\n" != kMitigationsHeader) return {};
  std::vector<MitigationRow> rows;
  while (std::getline(file, line)) {
    const std::size_t comma = line.find(',');
    const auto cells = cells_of(comma == std::string::npos ? "" : line.substr(comma + 1));
    if (cells.size() != 3 || !cells[2]) return {};
    rows.push_back({line.substr(0, comma), cells[0], cells[1], static_cast<int>(*cells[2])});
  }
  return rows;
}

std::vector<LabRow> read_lab_csv(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line) || line + "\n" != header()) return {};
  std::vector<LabRow> rows;
  while (std::getline(file, line)) {
    const auto cells = cells_of(line);
    if (cells.size() != kColumns || !cells[1] || !cells[7]) return {};
    LabRow row;
    row.worst_excess = *cells[1];
    row.degenerate = static_cast<int>(*cells[7]);
    for (std::size_t i = 0; i < kDetectors.size(); ++i) {
      row.scores.push_back(cells[9 + 2 * i].value_or(0.0));
      row.angles_deg.push_back(cells[10 + 2 * i]);
    }
    row.error_over_selected = cells[kColumns - 2];
    row.error_over_all = cells[kColumns - 1];
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace plumbline
