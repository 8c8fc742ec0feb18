#include "tools/report/sweep_charts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "tools/evaluation/quantile.h"
#include "tools/formats/number_text.h"
#include "tools/report/heat_map.h"
#include "tools/report/point_chart.h"

namespace plumbline {
namespace {

constexpr const char* kClasses[] = {"c0", "estimate", "c1", "c2", "warn", "truth"};

std::string class_of(std::size_t series) { return kClasses[series % std::size(kClasses)]; }

/// File names hold no surprises.
std::string file_name(std::string text) {
  for (char& c : text) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!is_plain) c = '_';
  }
  return text;
}

using Chosen = std::vector<const RunRow*>;
using Summary = std::function<std::optional<Interval>(const Chosen&)>;
using Selects = std::function<bool(const RunRow&)>;

Chosen chosen(const SweepView& view, const Selects& selects) {
  Chosen rows;
  for (const RunRow& row : view.rows) {
    if (selects(row)) rows.push_back(&row);
  }
  return rows;
}

std::optional<Interval> success_rate(const Chosen& rows) {
  if (rows.empty()) return std::nullopt;
  const auto successes = std::count_if(rows.begin(), rows.end(), [](const RunRow* row) { return row->is_ok(); });
  return wilson_interval(static_cast<std::size_t>(successes), rows.size());
}

std::vector<double> values_of(const Chosen& rows, const std::string& figure) {
  std::vector<double> values;
  for (const RunRow* row : rows) {
    if (const auto value = row->figure(figure)) values.push_back(*value);
  }
  return values;
}

std::optional<Interval> median_drift(const Chosen& rows) {
  return bootstrap_median(values_of(rows, "drift_percent"), "sweep.report.drift");
}

std::vector<PointChart::Tick> ticks_of(const AxisBins& axis) {
  std::vector<PointChart::Tick> ticks;
  for (const AxisBins::Bin& bin : axis.bins) ticks.push_back({bin.place, bin.label});
  return ticks;
}

/// A series per estimator over one axis.
Drawing over_axis(const SweepView& view, const AxisBins& axis, PointChart chart, const Summary& summary) {
  chart.name = file_name(chart.name + "_" + axis.key);
  chart.x_label = axis.key;
  chart.ticks = ticks_of(axis);
  chart.joined = axis.numeric;
  for (const std::string& estimator : view.plan.estimators) {
    PointChart::Series series{estimator, class_of(chart.series.size()), {}};
    for (std::size_t b = 0; b < axis.bins.size(); ++b) {
      const auto value = summary(
          chosen(view, [&](const RunRow& row) { return row.run.estimator == estimator && view.bin(axis, row) == b; }));
      if (value) series.points.push_back({axis.bins[b].place, *value});
    }
    chart.series.push_back(std::move(series));
  }
  return point_chart(chart);
}

std::vector<std::string> labels_of(const AxisBins& axis) {
  std::vector<std::string> labels;
  for (const AxisBins::Bin& bin : axis.bins) labels.push_back(bin.label);
  return labels;
}

/// How a summary becomes a cell's colour and words.
struct CellStyle {
  std::function<double(const Interval&)> badness;
  std::function<std::string(double)> text;
};

/// One estimator's summary over a pair of axes.
Drawing over_pair(const SweepView& view, const AxisBins& x, const AxisBins& y, const std::string& estimator,
                  HeatMap map, const Summary& summary, const CellStyle& style) {
  map.name = file_name(map.name + "_" + x.key + "_" + y.key + "_" + estimator);
  map.caption += ", " + estimator;
  map.x_label = x.key;
  map.y_label = y.key;
  map.columns = labels_of(x);
  map.rows = labels_of(y);
  for (std::size_t r = 0; r < y.bins.size(); ++r) {
    map.cells.emplace_back(x.bins.size());
    for (std::size_t c = 0; c < x.bins.size(); ++c) {
      const Chosen rows = chosen(view, [&](const RunRow& row) {
        return row.run.estimator == estimator && view.bin(x, row) == c && view.bin(y, row) == r;
      });
      const auto value = summary(rows);
      if (!value) continue;
      map.cells[r][c] = HeatMap::Cell{style.badness(*value), style.text(value->value),
                                      x.key + " " + x.bins[c].label + ", " + y.key + " " + y.bins[r].label + ": " +
                                          style.text(value->value) + " (" + style.text(value->low) + " … " +
                                          style.text(value->high) + "), " + std::to_string(rows.size()) + " runs"};
    }
  }
  return heat_map(map);
}

std::vector<Drawing> over_pairs(const SweepView& view, const HeatMap& map, const Summary& summary,
                                const CellStyle& style) {
  std::vector<Drawing> drawings;
  for (std::size_t x = 0; x < view.axes.size(); ++x) {
    for (std::size_t y = x + 1; y < view.axes.size(); ++y) {
      for (const std::string& estimator : view.plan.estimators) {
        drawings.push_back(over_pair(view, view.axes[x], view.axes[y], estimator, map, summary, style));
      }
    }
  }
  return drawings;
}

std::string percent_text(double share) { return readable_text(100.0 * share) + " %"; }

/// Drift spans decades: its colour goes by its logarithm, between the least and the largest of all runs.
CellStyle drift_style(const SweepView& view) {
  double low = 1e300;
  double high = 1e-300;
  for (const RunRow& row : view.rows) {
    const auto drift = row.figure("drift_percent");
    if (!drift || !(*drift > 0.0)) continue;
    low = std::min(low, *drift);
    high = std::max(high, *drift);
  }
  const double span = high > low ? std::log(high / low) : 0.0;
  return {[low, span](const Interval& drift) {
            return span > 0.0 && drift.value > 0.0 ? std::log(drift.value / low) / span : 0.0;
          },
          [](double drift) { return readable_text(drift); }};
}

/// Nothing for an estimator whose modules solve nothing.
std::optional<Drawing> degenerate_over(const SweepView& view, const AxisBins& axis, const std::string& estimator) {
  HeatMap map{"degenerate_" + file_name(axis.key + "_" + estimator),
              "Degenerate share of solves, " + estimator,
              "mean over runs",
              axis.key,
              "",
              labels_of(axis),
              {},
              {}};
  bool has_solves = false;
  for (const char* module : {"lidar", "vision"}) {
    map.rows.emplace_back(module);
    map.cells.emplace_back(axis.bins.size());
    for (std::size_t b = 0; b < axis.bins.size(); ++b) {
      const Chosen rows =
          chosen(view, [&](const RunRow& row) { return row.run.estimator == estimator && view.bin(axis, row) == b; });
      const std::vector<double> shares = values_of(rows, std::string("modules.") + module + ".degenerate_share");
      if (shares.empty()) continue;
      double mean = 0.0;
      for (const double share : shares) mean += share / static_cast<double>(shares.size());
      map.cells.back()[b] =
          HeatMap::Cell{mean, percent_text(mean),
                        std::string(module) + ", " + axis.key + " " + axis.bins[b].label + ": degenerate in " +
                            percent_text(mean) + " of its solves, " + std::to_string(shares.size()) + " runs"};
      has_solves = true;
    }
  }
  return has_solves ? std::optional(heat_map(map)) : std::nullopt;
}

}  // namespace

SweepView::SweepView(const SweepPlan& sweep_plan, const std::vector<RunRow>& sweep_rows)
    : plan(sweep_plan), rows(sweep_rows) {
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    AxisBins bins = bin_axis(plan, a);
    if (bins.bins.size() > 1) axes.push_back(std::move(bins));
  }
}

std::size_t SweepView::bin(const AxisBins& axis, const RunRow& row) const {
  return axis.bin_of_run[static_cast<std::size_t>(plan.find(row.run.key) - plan.runs.data())];
}

std::vector<Drawing> success_charts(const SweepView& view) {
  std::vector<Drawing> drawings;
  PointChart chart;
  chart.name = "success";
  chart.caption = "Success rate";
  chart.unit = "%";
  chart.percent = true;
  for (const AxisBins& axis : view.axes) drawings.push_back(over_axis(view, axis, chart, success_rate));
  HeatMap map;
  map.name = "success_map";
  map.caption = "Success rate";
  const CellStyle style{[](const Interval& rate) { return 1.0 - rate.value; }, percent_text};
  for (Drawing& drawing : over_pairs(view, map, success_rate, style)) drawings.push_back(std::move(drawing));
  return drawings;
}

std::vector<Drawing> drift_charts(const SweepView& view) {
  std::vector<Drawing> drawings;
  PointChart chart;
  chart.name = "drift";
  chart.caption = "Median drift";
  chart.unit = "% of the distance";
  for (const AxisBins& axis : view.axes) drawings.push_back(over_axis(view, axis, chart, median_drift));
  HeatMap map;
  map.name = "drift_map";
  map.caption = "Median drift";
  map.unit = "% of the distance, coloured by its logarithm";
  for (Drawing& drawing : over_pairs(view, map, median_drift, drift_style(view))) {
    drawings.push_back(std::move(drawing));
  }
  return drawings;
}

std::vector<Drawing> degeneracy_charts(const SweepView& view) {
  std::vector<Drawing> drawings;
  for (const AxisBins& axis : view.axes) {
    for (const std::string& estimator : view.plan.estimators) {
      if (auto drawing = degenerate_over(view, axis, estimator)) drawings.push_back(std::move(*drawing));
    }
  }
  return drawings;
}

}  // namespace plumbline
