#include "report/figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/quantile.h"
#include "model/likelihood.h"
#include "report/density.h"

namespace marey::report {

using render::Chart;
using render::Series;
using render::SeriesKind;

namespace {
const ReportSystem& systemAt(const ReportData& data, int index) {
  return data.systems[static_cast<size_t>(index)];
}

std::string figureId(const std::string& kind, int number) {
  return fmt::format("{}-{}", kind, number);
}

std::shared_ptr<const Clip> shortened(const std::shared_ptr<const Clip>& clip, double seconds) {
  const int frames = static_cast<int>(std::lround(seconds * clip->fps)) + 1;
  if (seconds <= 0.0 || frames >= clip->frameCount()) return clip;
  return std::make_shared<const Clip>(sliceFrames(*clip, 0, frames));
}

/// Time in which the first clip goes far enough that figures stand apart.
double autoStrobe(const Clip& clip) {
  constexpr double apartM = 0.75;
  double length = 0.0;
  for (int t = 1; t < clip.frameCount(); ++t) {
    const Vec3 step = clip.at(t, 0) - clip.at(t - 1, 0);
    length += std::hypot(step.x(), step.z());
  }
  const double speed = length / std::max(1e-3, clip.seconds());
  return std::clamp(std::round(20.0 * apartM / std::max(speed, 0.01)) / 20.0, 0.3, 2.0);
}

constexpr double kCutShare = 0.02;  ///< of a likelihood figure's points that may lie below its axis
constexpr double kDeepDrop = 2.0;   ///< heights of the others by which they then lie below

std::vector<double> column(const std::vector<std::vector<double>>& runs, size_t frame) {
  std::vector<double> values;
  for (const auto& run : runs) {
    if (frame < run.size() && std::isfinite(run[frame])) values.push_back(run[frame]);
  }
  return values;
}

/// Median line and 5-95 % band over the runs of a group; frames that nobody scored break the line.
void addLikelihood(Chart& chart, const ReportData& data, const LikelihoodGroup& group, double fps) {
  const ReportSystem& system = systemAt(data, group.system);
  Series band{
      .kind = SeriesKind::Band, .colour = systemColour(system), .opacity = 0.16, .inLegend = false};
  Series line{.kind = SeriesKind::Line, .name = system.name, .colour = systemColour(system)};
  size_t frames = 0;
  for (const auto& run : group.nats) frames = std::max(frames, run.size());
  for (size_t t = 0; t < frames; ++t) {
    const std::vector<double> values = column(group.nats, t);
    if (values.empty()) continue;
    const double time = static_cast<double>(t) / fps;
    line.x.push_back(time);
    line.y.push_back(quantile(values, 0.5));
    band.x.push_back(time);
    band.low.push_back(quantile(values, 0.05));
    band.high.push_back(quantile(values, 0.95));
  }
  if (group.nats.size() > 1) chart.series.push_back(std::move(band));
  chart.series.push_back(std::move(line));
}

Chart footstepChart(const ReportData& data, const FootstepPanel& panel) {
  Chart chart{.title = panel.title};
  chart.x = {.label = "speed tolerance", .unit = "cm/s"};
  chart.y = {.label = "footsteps"};
  for (const FootstepSeries& curve : panel.curves) {
    const ReportSystem& system = systemAt(data, curve.system);
    chart.series.push_back({.kind = SeriesKind::Line,
                            .name = system.name,
                            .colour = systemColour(system),
                            .x = curve.toleranceCmS,
                            .y = curve.count});
  }
  for (const FootstepSeries& curve : panel.curves) {
    const auto at = std::find_if(curve.toleranceCmS.begin(), curve.toleranceCmS.end(),
                                 [&](double v) { return v >= curve.v95CmS - 1e-9; });
    if (at == curve.toleranceCmS.end() || !std::isfinite(curve.v95CmS)) continue;
    const auto index = static_cast<size_t>(at - curve.toleranceCmS.begin());
    chart.series.push_back({.kind = SeriesKind::Dots,
                            .name = systemAt(data, curve.system).name,
                            .colour = systemColour(systemAt(data, curve.system)),
                            .x = {*at},
                            .y = {curve.count[index]},
                            .inLegend = false});
  }
  return chart;
}

/// The middle 99 % of all values of a panel, so that one outlier does not flatten the rest.
std::pair<double, double> centralRange(const DistributionPanel& panel) {
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  for (const SystemSamples& s : panel.samples) {
    if (s.values.empty()) continue;
    low = std::min(low, quantile(s.values, 0.005));
    high = std::max(high, quantile(s.values, 0.995));
  }
  const double margin = high > low ? 0.06 * (high - low) : 1.0;
  const bool positive = low >= 0.0;
  return {positive ? std::max(0.0, low - margin) : low - margin, high + margin};
}

std::optional<Chart> distributionChart(const ReportData& data, const DistributionPanel& panel) {
  Chart chart{.title = panel.joint};
  chart.x = {.label = panel.quantity, .unit = panel.unit};
  chart.y = {.showTicks = false};
  const auto [low, high] = centralRange(panel);
  if (!(low < high)) return std::nullopt;
  chart.x.range = {low, high};
  for (const SystemSamples& s : panel.samples) {
    if (s.values.empty()) continue;
    const ReportSystem& system = systemAt(data, s.system);
    const DensityCurve curve = kernelDensity(s.values, low, high, 140);
    chart.series.push_back({.kind = SeriesKind::Density,
                            .name = system.name,
                            .colour = systemColour(system),
                            .x = curve.x,
                            .y = curve.y,
                            .width = 1.6,
                            .opacity = system.natural ? 0.14 : 0.10});
  }
  return chart;
}

std::string sentence(const std::string& what, size_t count) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}
}  // namespace

render::Colour systemColour(const ReportSystem& system) {
  return system.natural ? render::naturalColour() : render::colourOf(system.colourIndex);
}

Figure sceneFigure(const ReportData& data, const ScenePanel& panel, int number) {
  std::vector<render::SceneMotion> motions;
  const bool natural = std::any_of(data.systems.begin(), data.systems.end(), [&](const auto& s) {
    return s.natural && s.clips.contains(panel.path);
  });
  size_t shown = 0;
  double seconds = 0.0, strobeS = panel.strobeS;
  for (const ReportSystem& system : data.systems) {
    const auto found = system.clips.find(panel.path);
    if (found == system.clips.end()) continue;
    const size_t count = std::min(found->second.size(), static_cast<size_t>(panel.clipsPerSystem));
    for (size_t i = 0; i < count; ++i) {
      const auto clip = shortened(found->second[i], panel.seconds);
      if (strobeS <= 0.0) strobeS = autoStrobe(*clip);
      motions.push_back({.clip = clip,
                         .colour = systemColour(system),
                         .opacity = system.natural ? 1.0 : render::sampleOpacity(count, natural),
                         .label = system.name});
      seconds = std::max(seconds, clip->seconds());
      ++shown;
    }
  }
  Figure figure{.id = figureId("scene", number), .section = Section::Motion, .title = panel.title};
  figure.caption = fmt::format(
      "{} over each other, one figure every {:g} s of {:.1f} s. Left limbs are drawn lighter. "
      "Rings mark where "
      "a foot rests; the grey line is the path that was asked for. Floor cells are 0.5 m.",
      sentence("motion", shown), strobeS, seconds);
  render::Shot shot = render::printed(std::move(motions));
  shot.options.path = panel.line;
  shot.view = panel.view;
  shot.orthographic = panel.orthographic;
  shot.caption.legend = true;  // the caption names nobody
  figure.scene = render::strobed(std::move(shot), strobeS);
  return figure;
}

/// Where a few frames are so unlikely that nothing else could be seen, the axis is cut above them.
/// Returns the lowest value that lies below it; NaN where none does.
double cutDeepDrops(Chart& chart) {
  std::vector<double> lows, highs;
  for (const Series& series : chart.series) {
    const bool band = series.kind == SeriesKind::Band;
    for (const double v : band ? series.low : series.y) lows.push_back(v);
    for (const double v : band ? series.high : series.y) highs.push_back(v);
  }
  if (lows.size() < 2) return std::nan("");
  const double least = *std::min_element(lows.begin(), lows.end()),
               most = *std::max_element(highs.begin(), highs.end()),
               central = quantile(lows, kCutShare), margin = 0.06 * (most - central);
  if (!(central - least > kDeepDrop * (most - central))) return std::nan("");
  chart.y.range = std::pair(central - margin, most + margin);
  return least;
}

Figure likelihoodFigure(const ReportData& data, const LikelihoodPanel& panel, int number) {
  Chart chart;
  chart.x = {.label = "time", .unit = "s"};
  chart.y = {.label = "log-likelihood", .unit = panel.unit};
  for (const LikelihoodGroup& group : panel.groups) addLikelihood(chart, data, group, panel.fps);
  chart.legend = render::LegendPlace::Direct;
  Figure figure{
      .id = figureId("likelihood", number), .section = Section::Likelihood, .title = panel.title};
  figure.caption = fmt::format(
      "Log-likelihood of each frame under the model ({}): the line is the median over runs, the "
      "band "
      "their 5 to 95 % range. Higher means more expected by the model; drops show frames that it "
      "finds unlikely.",
      panel.unit);
  if (panel.linearGaussianNats) {
    chart.series.push_back({.kind = SeriesKind::HorizontalRule,
                            .name = "linear-Gaussian",
                            .colour = render::grey(0.45),
                            .y = {*panel.linearGaussianNats},
                            .width = 1.4,
                            .dashed = true});
    figure.caption +=
        " The dashed line is the mean of a linear-Gaussian autoregression over all natural clips, "
        "fitted on the model's training data with the same observation floor.";
  }
  if (const double least = cutDeepDrops(chart); std::isfinite(least))
    figure.caption += fmt::format(" The axis is cut: single frames go down to {:.0f}.", least);
  if (!panel.note.empty()) figure.caption += " " + panel.note;
  figure.chart = render::single(std::move(chart));
  figure.size = {720, 300};
  return figure;
}

Figure footstepFigure(const ReportData& data) {
  render::ChartGrid grid;
  grid.columns = data.footsteps.size() > 1 ? 2 : 1;
  grid.shareX = true;
  for (const FootstepPanel& panel : data.footsteps)
    grid.charts.push_back(footstepChart(data, panel));
  const size_t rows = (grid.charts.size() + static_cast<size_t>(grid.columns) - 1) /
                      static_cast<size_t>(grid.columns);
  Figure figure{
      .id = "footsteps", .section = Section::Footsteps, .title = "Footsteps by speed tolerance"};
  figure.caption =
      "How many footsteps are counted when a foot that moves slower than the tolerance (horizontal "
      "axis, "
      "cm/s) is taken as planted. The dot is v95, the smallest tolerance that finds 95 % of the "
      "highest "
      "count: the further left, the more sharply the feet are planted; foot sliding moves it to "
      "the right.";
  figure.chart = std::move(grid);
  figure.size = {720, 70.0 + 210.0 * static_cast<double>(rows)};
  return figure;
}

Figure gaitFigure(const ReportData& data, const GaitPanel& panel, int number) {
  Chart chart;
  chart.x = {.label = "time", .unit = "s"};
  if (panel.seconds > 0.0) chart.x.range = {0.0, panel.seconds};
  for (size_t r = 0; r < panel.rows.size(); ++r) {
    const GaitRow& row = panel.rows[r];
    const ReportSystem& system = systemAt(data, row.system);
    chart.y.categories.push_back(system.name + ", " + row.foot);
    Series series{.kind = SeriesKind::Intervals,
                  .name = system.name,
                  .colour = systemColour(system),
                  .width = 0.62};
    for (const auto& [begin, end] : row.contactsS) {
      series.y.push_back(static_cast<double>(r) + 0.5);
      series.low.push_back(begin);
      series.high.push_back(end);
    }
    chart.series.push_back(std::move(series));
  }
  chart.legend = render::LegendPlace::None;
  Figure figure{
      .id = figureId("gait", number), .section = Section::Footsteps, .title = panel.title};
  figure.caption =
      "Gait diagram: a bar while a foot counts as planted. Even, "
      "alternating bars of about the natural length are a steady walk; short scraps are sliding or "
      "jitter.";
  figure.chart = render::single(std::move(chart));
  figure.size = {720, 60.0 + 30.0 * static_cast<double>(panel.rows.size())};
  return figure;
}

Figure distributionFigure(const ReportData& data, const std::string& quantity) {
  render::ChartGrid grid;
  grid.columns = 3;
  for (const DistributionPanel& panel : data.distributions) {
    if (panel.quantity != quantity) continue;
    if (auto chart = distributionChart(data, panel)) grid.charts.push_back(std::move(*chart));
  }
  const size_t rows = (grid.charts.size() + 2) / 3;
  std::string id = "distribution-" + quantity;
  std::replace_if(
      id.begin(), id.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '-');
  Figure figure{.id = id, .section = Section::Distributions, .title = "Joint " + quantity};
  figure.caption = "How often each joint has which " + quantity +
                   " (kernel density, equal areas; the middle 99 % of values). Where a system's "
                   "curve lies on the "
                   "natural one, its motion has the natural spread; a narrower curve is too tame, "
                   "a wider one too wild.";
  figure.chart = std::move(grid);
  figure.size = {720, 40.0 + 170.0 * static_cast<double>(rows)};
  return figure;
}

std::vector<Figure> figuresOf(const ReportData& data) {
  std::vector<Figure> figures;
  int number = 0;
  for (const ScenePanel& panel : data.scenes) figures.push_back(sceneFigure(data, panel, ++number));
  number = 0;
  for (const LikelihoodPanel& panel : data.likelihoods)
    figures.push_back(likelihoodFigure(data, panel, ++number));
  if (!data.footsteps.empty()) figures.push_back(footstepFigure(data));
  number = 0;
  for (const GaitPanel& panel : data.gaits) figures.push_back(gaitFigure(data, panel, ++number));
  std::set<std::string> done;
  for (const DistributionPanel& panel : data.distributions) {
    if (done.insert(panel.quantity).second)
      figures.push_back(distributionFigure(data, panel.quantity));
  }
  std::erase_if(figures, [](const Figure& f) { return f.chart && f.chart->charts.empty(); });
  return figures;
}

}  // namespace marey::report
