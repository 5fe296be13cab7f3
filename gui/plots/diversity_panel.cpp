#include "gui/plots/diversity_panel.h"

#include <QLabel>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "gui/plots/diversity_data.h"
#include "gui/plots/plot_panel.h"

namespace marey::gui {
namespace {

class DiversityPanel : public PlotPanel {
 public:
  DiversityPanel(Workspace& workspace, QWidget* parent)
      : PlotPanel(workspace, QStringLiteral("diversity"), true, parent) {
    m_means = new QLabel(this);
    m_means->setObjectName(QStringLiteral("diversityMeans"));
    m_means->setWordWrap(true);
    m_means->setTextInteractionFlags(Qt::TextSelectableByMouse);
    content()->addWidget(m_means);
    chart()->setToolTip(tr(
        "Root mean square joint distance in the root frame, mean over pairs of motions at equal "
        "time from the start; of a picked motion, its mean distance from the others. Natural pairs "
        "follow different paths."));
  }

 protected:
  void refresh() override {
    m_sets = motionSets(workspace().motions().groups());
    const auto& sets = m_sets;
    showCounted(sets);
    const bool pairs = std::any_of(sets.begin(), sets.end(),
                                   [](const MotionSet& s) { return s.clips.size() > 1; });
    if (!pairs)
      return showHint(
          tr("Diversity compares pairs: use at least two motions of a group, for "
             "example by sampling a path."));
    using Compared = std::pair<std::vector<DiversityCurve>, std::vector<std::string>>;
    compute<Compared>(
        tr("Comparing motions"),
        [sets](Progress& progress) {
          Compared out;
          out.first = diversityCurves(sets, progress, &out.second);
          return out;
        },
        [this](Compared& compared) {
          m_curves = std::move(compared.first);
          showCounted(m_sets, compared.second);
          showGrid(diversityGrid(m_curves));
          showMeans();
        });
  }

  void rangeMoved() override { showMeans(); }

  std::vector<ChartHighlight> curvesOf(const std::set<MotionId>& picked) const override {
    return diversityHighlights(m_curves, picked);
  }

 private:
  void showMeans() {
    QStringList parts;
    for (const DiversityCurve& curve : m_curves) {
      const double mean = meanInRange(curve, workspace().view().range());
      if (std::isfinite(mean))
        parts << (mean == 0.0 ? tr("%1 %2 cm (%3 motions, all the same: the model draws nothing)")
                              : tr("%1 %2 cm (%3 motions)"))
                     .arg(QString::fromStdString(curve.look.name))
                     .arg(mean, 0, 'f', 1)
                     .arg(curve.compared);
    }
    const QString where = workspace().view().range() ? tr("Mean in the range: ") : tr("Mean: ");
    m_means->setText(parts.isEmpty() ? QString() : where + parts.join(QStringLiteral("; ")));
  }

  QLabel* m_means = nullptr;
  std::vector<MotionSet> m_sets;
  std::vector<DiversityCurve> m_curves;
};
}  // namespace

QWidget* makeDiversityPanel(Workspace& workspace, QWidget* parent) {
  return new DiversityPanel(workspace, parent);
}

}  // namespace marey::gui
