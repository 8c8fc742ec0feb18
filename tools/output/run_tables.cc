#include "tools/output/run_tables.h"

#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

// Nine digits give back a float; eigenvectors and eigenvalues are read by statistics, not by arithmetic.
constexpr int kDigits = 9;

void append_header(std::string& text) {
  text += "stamp_ns,module,mode";
  for (int i = 1; i <= 6; ++i) text += ",lambda_" + std::to_string(i);
  for (int i = 1; i <= 6; ++i) {
    for (int j = 1; j <= 6; ++j) text += ",v_" + std::to_string(i) + "_" + std::to_string(j);
  }
  text += ",well_conditioned\n";
}

void append_row(std::string& text, const ModuleHealth& row) {
  text += std::to_string(row.stamp_ns);
  (text += ',') += to_string(row.module);
  (text += ',') += to_string(row.mode);
  for (int i = 0; i < 6; ++i) append_general(text += ',', row.eigenvalues[i], kDigits);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) append_general(text += ',', row.eigenvectors(j, i), kDigits);
  }
  (text += ',') += std::to_string(row.well_conditioned);
  text += '\n';
}

}  // namespace

std::string degeneracy_csv(const std::vector<ModuleHealth>& health) {
  std::string text;
  text.reserve(512 + health.size() * 560);
  append_header(text);
  for (const ModuleHealth& row : health) append_row(text, row);
  return text;
}

std::string localization_csv(const std::vector<MapMatch>& matches) {
  std::string text = "stamp_ns,agreement,overlap,support,correction_m,correction_rad,iterations,wall_ms\n";
  for (const MapMatch& match : matches) {
    text += std::to_string(match.stamp_ns);
    (text += ',') += to_string(match.agreement);
    for (const double value : {match.overlap, match.support, match.correction_m, match.correction_rad}) {
      append_general(text += ',', value, kDigits);
    }
    (text += ',') += std::to_string(match.iterations);
    append_fixed(text += ',', 1e3 * match.processing_s, 6);
    text += '\n';
  }
  return text;
}

std::string timing_csv(const std::vector<TimingRow>& timing) {
  std::string text = "stamp_ns,module,wall_ms\n";
  text.reserve(text.size() + timing.size() * 32);
  for (const TimingRow& row : timing) {
    text += std::to_string(row.stamp_ns);
    (text += ',') += to_string(row.module);
    append_fixed(text += ',', 1e3 * row.wall_s, 6);
    text += '\n';
  }
  return text;
}

}  // namespace plumbline
