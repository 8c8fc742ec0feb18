#pragma once

#include <string>

#include "scenarios/run_record.h"
#include "scenarios/scenario.h"
#include "tools/evaluation/figures.h"
#include "tools/evaluation/verdict.h"
#include "tools/output/provenance.h"

namespace plumbline {

/// What a report shows; everything outlives the call.
struct RunReport {
  const Scenario& scenario;
  const RunRecord& record;
  const RunFigures& figures;
  const Verdict& verdict;
  const Provenance& provenance;
};

/// report.html: one page that needs nothing but itself.
std::string report_html(const RunReport& report);

}  // namespace plumbline
