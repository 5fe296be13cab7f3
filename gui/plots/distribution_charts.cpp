#include <algorithm>
#include <cmath>
#include <limits>

#include "gui/plots/distribution_data.h"

#include "base/quantile.h"
#include "report/density.h"
#include "stats/sample_distance.h"

namespace marey::gui {
namespace {
using render::Series;
using render::SeriesKind;
constexpr int kPoints = 140;

struct Extent {
  double low = 0.0, high = 1.0;
};

/// The middle 99 % of all values, so that one outlier does not flatten the rest.
std::optional<Extent> centralExtent(const DistributionResult& result, size_t joint) {
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  for (const DistributionSet& set : result.sets) {
    std::vector<double> values = set.values[joint].pooled;
    if (values.empty()) continue;
    std::sort(values.begin(), values.end());
    low = std::min(low, sortedQuantile(values, 0.005));
    high = std::max(high, sortedQuantile(values, 0.995));
  }
  if (low > high) return std::nullopt;
  const double margin = high > low ? 0.06 * (high - low) : 1.0;
  return Extent{low >= 0.0 ? std::max(0.0, low - margin) : low - margin, high + margin};
}

void addDensities(LinkedGrid& out, const DistributionResult& result, size_t joint,
                  const Extent& extent) {
  render::Chart& chart = out.grid.charts.back();
  chart.x.range = {extent.low, extent.high};
  chart.y = {.label = "density", .showTicks = false};
  double lowestPeak = std::numeric_limits<double>::max(), highestPeak = 0.0;
  for (const DistributionSet& set : result.sets) {
    if (set.values[joint].pooled.empty()) continue;
    const auto curve =
        report::kernelDensity(set.values[joint].pooled, extent.low, extent.high, kPoints);
    const double peak = *std::max_element(curve.y.begin(), curve.y.end());
    lowestPeak = std::min(lowestPeak, peak);
    highestPeak = std::max(highestPeak, peak);
    Series series = set.look.line(curve.x, curve.y);
    series.kind = SeriesKind::Density;
    series.opacity = set.look.natural ? 0.14 : 0.10;
    out.add(std::move(series), set.look.ids);
  }
  // The spike of a set that hardly moves is cut, so that it does not flatten the others.
  if (highestPeak > 0.0)
    out.grid.charts.back().y.range = {0.0, 1.06 * std::min(highestPeak, 6.0 * lowestPeak)};
}

/// Violins lie on their side, a row each; the dot is the median, its bar the quartiles.
void addViolins(LinkedGrid& out, const DistributionResult& result, size_t joint,
                const Extent& extent) {
  render::Chart& chart = out.grid.charts.back();
  chart.x.range = {extent.low, extent.high};
  chart.legend = render::LegendPlace::None;
  double row = 0.5;
  for (const DistributionSet& set : result.sets) {
    std::vector<double> values = set.values[joint].pooled;
    if (values.empty()) continue;
    out.grid.charts.back().y.categories.push_back(set.look.name);
    const auto curve = report::kernelDensity(values, extent.low, extent.high, kPoints);
    const double peak = *std::max_element(curve.y.begin(), curve.y.end());
    std::vector<double> low, high;
    for (const double y : curve.y) {
      low.push_back(row - 0.42 * y / peak);
      high.push_back(row + 0.42 * y / peak);
    }
    Series band = set.look.band(curve.x, std::move(low), std::move(high));
    band.name = set.look.name;
    band.opacity = 0.45;
    out.add(std::move(band), set.look.ids);
    std::sort(values.begin(), values.end());
    out.add({.kind = SeriesKind::Dots,
             .name = set.look.name + ", median and quartiles",
             .colour = set.look.colour,
             .x = {sortedQuantile(values, 0.5)},
             .y = {row},
             .low = {sortedQuantile(values, 0.25)},
             .high = {sortedQuantile(values, 0.75)},
             .errorAxis = 'x'},
            set.look.ids);
    row += 1.0;
  }
}

/// A speed is that from the frame before: its first value belongs to frame 1.
double firstFrame(const DistributionResult& result) {
  return result.query.quantity == stats::Quantity::Speed ? 1.0 : 0.0;
}

void addEnvelopes(LinkedGrid& out, const DistributionResult& result, size_t joint) {
  const stats::QuantityText& text = stats::textOf(result.query.quantity);
  render::Chart& chart = out.grid.charts.back();
  chart.x = {.label = "time", .unit = "s"};
  chart.y = {.label = text.name, .unit = text.unit};
  for (const DistributionSet& set : result.sets) {
    Band band = bandOf(set.values[joint].byMotion);
    for (double& t : band.step) t = (t + firstFrame(result)) / set.fps;
    if (band.step.empty()) continue;
    if (set.values[joint].byMotion.size() > 1)
      out.add(set.look.band(band.step, band.low, band.high), set.look.ids);
    out.add(set.look.line(std::move(band.step), std::move(band.median)), set.look.ids);
  }
}
}  // namespace

LinkedGrid distributionGrid(const DistributionResult& result, DistributionView view) {
  LinkedGrid out;
  const stats::QuantityText& text = stats::textOf(result.query.quantity);
  for (size_t k = 0; k < result.query.joints.size(); ++k) {
    const auto extent = centralExtent(result, k);
    if (!extent) continue;
    out.grid.charts.push_back(
        {.title = result.skeleton->names[static_cast<size_t>(result.query.joints[k])]});
    out.grid.charts.back().x = {.label = text.name, .unit = text.unit};
    if (view == DistributionView::Density) addDensities(out, result, k, *extent);
    if (view == DistributionView::Violin) addViolins(out, result, k, *extent);
    if (view == DistributionView::Envelope) addEnvelopes(out, result, k);
  }
  const auto charts = static_cast<int>(out.grid.charts.size());
  out.grid.columns = charts > 4 ? 3 : std::max(1, std::min(charts, 2));
  out.grid.shareX = view == DistributionView::Envelope;
  return out;
}

namespace {
/// The values of one motion that count: those inside the range.
std::vector<double> valuesInRange(const DistributionResult& result, const DistributionSet& set,
                                  const std::vector<double>& run) {
  if (!result.query.range) return run;
  std::vector<double> out;
  for (size_t i = 0; i < run.size(); ++i) {
    const double time = (static_cast<double>(i) + firstFrame(result)) / set.fps;
    if (time >= result.query.range->beginS && time <= result.query.range->endS)
      out.push_back(run[i]);
  }
  return out;
}

/// The density of one motion; in violins it rises from the middle of the set's row.
std::optional<ChartHighlight> densityOf(const DistributionResult& result,
                                        const DistributionSet& set, const std::vector<double>& run,
                                        int chart, const render::Chart& shown) {
  const std::vector<double> values = valuesInRange(result, set, run);
  if (values.empty() || !shown.x.range) return std::nullopt;
  auto curve = report::kernelDensity(values, shown.x.range->first, shown.x.range->second, kPoints);
  const auto& rows = shown.y.categories;
  const auto row = std::find(rows.begin(), rows.end(), set.look.name);
  const double peak = *std::max_element(curve.y.begin(), curve.y.end());
  if (row != rows.end())
    for (double& y : curve.y)
      y = static_cast<double>(row - rows.begin()) + 0.5 - 0.42 * y / std::max(peak, 1e-300);
  return set.look.highlight(chart, std::move(curve.x), std::move(curve.y));
}

ChartHighlight overTime(const DistributionResult& result, const DistributionSet& set,
                        const std::vector<double>& run, int chart) {
  std::vector<double> x = framesInSeconds(run.size(), set.fps);
  for (double& t : x) t += firstFrame(result) / set.fps;
  return set.look.highlight(chart, std::move(x), run);
}
}  // namespace

std::vector<ChartHighlight> distributionHighlights(const DistributionResult& result,
                                                   DistributionView view,
                                                   const render::ChartGrid& shown,
                                                   const std::set<MotionId>& picked) {
  std::vector<ChartHighlight> out;
  for (size_t k = 0; k < result.query.joints.size(); ++k) {
    const std::string& joint = result.skeleton->names[static_cast<size_t>(result.query.joints[k])];
    const auto chart = std::find_if(shown.charts.begin(), shown.charts.end(),
                                    [&](const render::Chart& c) { return c.title == joint; });
    if (chart == shown.charts.end()) continue;  // not defined at this joint
    const auto index = static_cast<int>(chart - shown.charts.begin());
    for (const DistributionSet& set : result.sets) {
      if (!set.look.singles(picked)) continue;
      const auto& runs = set.values[k].byMotion;
      for (size_t i = 0; i < runs.size() && out.size() < kMostHighlights; ++i) {
        if (!picked.contains(set.look.ids[i])) continue;
        if (view == DistributionView::Envelope)
          out.push_back(overTime(result, set, runs[i], index));
        else if (auto curve = densityOf(result, set, runs[i], index, *chart))
          out.push_back(std::move(*curve));
      }
    }
  }
  return out;
}

}  // namespace marey::gui
