#include "tools/output/run_files.h"

#include "estimator/estimator.h"
#include "tools/evaluation/alignment.h"
#include "tools/formats/point_cloud_file.h"
#include "tools/formats/tum.h"
#include "tools/output/result_json.h"
#include "tools/output/run_tables.h"
#include "tools/process_clock.h"
#include "tools/report/run_report.h"

namespace plumbline {
namespace {

void write_data(const RunDirectory& directory, const Scenario& scenario, const RunRecord& record) {
  directory.write("ground_truth.tum", tum_text(record.ground_truth));
  directory.write("estimate.tum", tum_text(record.estimate));
  directory.write("degeneracy.csv", degeneracy_csv(record.health));
  directory.write("timing.csv", timing_csv(record.timing));
  if (!record.prior_map.empty()) directory.write("localization.csv", localization_csv(record.map_matches));
  directory.write("scenario.yaml", scenario.resolved_yaml);
  write_ply(directory.staged("map.ply").string(), record.map);
  const std::vector<PosePair> pairs = pair_poses(record.ground_truth, record.estimate);
  if (!pairs.empty()) write_place_on_site(directory.staged("map.ply"), place_on_site(pairs));
}

void take_wall_time(RunFigures& figures) {
  const double wall_s = seconds_since_process_start();
  figures.wall_s = wall_s;
  if (wall_s > 0.0) figures.real_time_factor = figures.simulated_s / wall_s;
}

}  // namespace

JudgedRun write_run(RunDirectory& directory, const Scenario& scenario, const RunRecord& record,
                    const std::function<double(const Eigen::Vector3d&)>& distance_to_surface,
                    const Provenance& provenance) {
  JudgedRun run;
  run.figures = run_figures(record, distance_to_surface);
  write_data(directory, scenario, record);
  take_wall_time(run.figures);
  run.verdict = judge(scenario, record, run.figures);
  directory.write("report.html", report_html({scenario, record, run.figures, run.verdict, provenance}));
  // The page's own share of the time is in result.json, which is what counts.
  take_wall_time(run.figures);
  run.verdict = judge(scenario, record, run.figures);
  directory.write("result.json", result_json(run.figures, run.verdict, record, provenance));
  directory.commit();
  return run;
}

}  // namespace plumbline
