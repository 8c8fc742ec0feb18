#include "tools/study/regress_outputs.h"

#include "tools/output/atomic_file.h"
#include "tools/report/regress_report.h"
#include "tools/report/regress_text.h"

namespace plumbline {

void write_regress_outputs(const std::filesystem::path& root, const Regression& regression) {
  const RegressReport report = regress_report(regression);
  for (const Drawing& chart : report.charts) {
    write_file_atomically(root / "charts" / (chart.name + ".svg"), svg_document(chart));
  }
  write_file_atomically(root / "regress.md", regress_markdown(regression));
  write_file_atomically(root / "regress.html", report.html);
}

}  // namespace plumbline
