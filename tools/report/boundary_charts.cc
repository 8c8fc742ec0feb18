#include <cmath>

#include "tools/formats/number_text.h"
#include "tools/report/point_chart.h"
#include "tools/report/sweep_charts.h"
#include "tools/study/boundary_curves.h"

namespace plumbline {
namespace {

constexpr int kCurveSteps = 60;
constexpr int kTicks = 5;

std::vector<PointChart::Tick> ticks_over(const SweepAxis& axis) {
  std::vector<PointChart::Tick> ticks;
  for (int i = 0; i <= kTicks; ++i) {
    const double share = static_cast<double>(i) / kTicks;
    ticks.push_back({share, readable_text(value_of_share(axis, share))});
  }
  return ticks;
}

/// What the runs gave: a dot per value that was tried, from few trials without an interval worth drawing.
PointChart::Series trials_of(const BoundaryCurve& curve, const std::vector<RunRow>& rows) {
  PointChart::Series series{"runs made, share that succeeded", "estimate", {}};
  for (std::size_t v = 0; v < curve.positions.size(); ++v) {
    double made = 0.0;
    double succeeded = 0.0;
    for (const std::string& key : curve.keys[v]) {
      for (const RunRow& row : rows) {
        if (row.run.key != key) continue;
        made += 1.0;
        succeeded += row.is_ok() ? 1.0 : 0.0;
      }
    }
    if (made == 0.0) continue;
    const double rate = succeeded / made;
    series.points.push_back({curve.positions[v], {rate, rate, rate}});
  }
  return series;
}

PointChart::Series fit_of(const SuccessCurve& curve) {
  std::vector<double> at;
  for (int i = 0; i <= kCurveSteps; ++i) at.push_back(static_cast<double>(i) / kCurveSteps);
  PointChart::Series series{"fitted success curve, 95 % band", "c0", {}};
  for (const CurvePoint& point : curve.curve(at)) {
    series.points.push_back({point.position, {point.mean, point.low, point.high}});
  }
  return series;
}

}  // namespace

std::vector<Drawing> boundary_charts(const SweepView& view) {
  std::vector<Drawing> drawings;
  if (!view.plan.boundary()) return drawings;
  const SweepAxis& axis = view.plan.axes[*view.plan.boundary()];
  for (const BoundaryCurve& curve : boundary_curves(view.plan)) {
    PointChart chart;
    chart.name = "boundary_" + std::to_string(drawings.size() + 1);
    chart.caption = "Success, " + curve.label;
    chart.unit = "%";
    chart.percent = true;
    chart.x_label = axis.key;
    chart.ticks = ticks_over(axis);
    chart.style = PointChart::Style::kBand;
    chart.series = {fit_of(replay(curve, view.rows).search.curve())};
    Drawing drawing = point_chart(chart);
    chart.style = PointChart::Style::kWhiskers;
    chart.joined = false;
    chart.series = {trials_of(curve, view.rows)};
    const Drawing dots = point_chart(chart);
    drawing.body += dots.body;
    drawing.legend.insert(drawing.legend.end(), dots.legend.begin(), dots.legend.end());
    drawings.push_back(std::move(drawing));
  }
  return drawings;
}

}  // namespace plumbline
