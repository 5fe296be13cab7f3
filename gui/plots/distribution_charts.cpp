#include <algorithm>
#include <cmath>
#include <limits>

#include "plots/distribution_data.h"

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
    low = std::min(low, stats::sortedQuantile(values, 0.005));
    high = std::max(high, stats::sortedQuantile(values, 0.995));
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
             .x = {stats::sortedQuantile(values, 0.5)},
             .y = {row},
             .low = {stats::sortedQuantile(values, 0.25)},
             .high = {stats::sortedQuantile(values, 0.75)},
             .errorAxis = 'x'},
            set.look.ids);
    row += 1.0;
  }
}

void addEnvelopes(LinkedGrid& out, const DistributionResult& result, size_t joint) {
  const stats::QuantityText& text = stats::textOf(result.query.quantity);
  render::Chart& chart = out.grid.charts.back();
  chart.x = {.label = "time", .unit = "s"};
  chart.y = {.label = text.name, .unit = text.unit};
  for (const DistributionSet& set : result.sets) {
    Band band = bandOf(set.values[joint].byMotion);
    // A speed is that from the frame before: its first value belongs to frame 1.
    const double shift = result.query.quantity == stats::Quantity::Speed ? 1.0 : 0.0;
    for (double& t : band.step) t = (t + shift) / set.fps;
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

}  // namespace marey::gui
