#include "tools/study/sweep_outputs.h"

#include "scenarios/input_error.h"
#include "tools/output/atomic_file.h"
#include "tools/report/sweep_report.h"
#include "tools/study/boundary_curves.h"
#include "tools/study/sweep_tables.h"

namespace plumbline {

void write_sweep_outputs(const std::filesystem::path& root, const SweepPlan& plan, const std::vector<RunRow>& rows) {
  write_file_atomically(root / "table.csv", table_csv(plan, rows));
  write_file_atomically(root / "table.jsonl", table_jsonl(plan, rows));
  write_file_atomically(root / "timing.csv", sweep_timing_csv(rows));
  if (plan.boundary()) write_file_atomically(root / "boundary.csv", boundary_csv(plan, rows));
  std::error_code error;
  std::filesystem::create_directories(root / "charts", error);
  if (error) throw InputError((root / "charts").string() + ": cannot be created: " + error.message());
  const LabFindings lab = plan.detectors.empty() ? LabFindings{} : lab_findings(plan, root);
  if (!plan.detectors.empty()) {
    write_file_atomically(root / "detectors.csv", detectors_csv(lab));
    write_file_atomically(root / "mitigations.csv", mitigations_csv(lab));
  }
  const SweepReport report = sweep_report(plan, rows, lab);
  for (const Drawing& chart : report.charts) {
    write_file_atomically(root / "charts" / (chart.name + ".svg"), svg_document(chart));
  }
  write_file_atomically(root / "report.html", report.html);
}

}  // namespace plumbline
