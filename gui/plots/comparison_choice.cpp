#include "gui/plots/comparison_choice.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QPushButton>

#include "gui/workspace/workspace.h"

namespace marey::gui {
namespace {

QString listed(const std::vector<std::string>& names) {
  QStringList out;
  for (const std::string& name : names) out << QString::fromStdString(name);
  return out.join(QStringLiteral(", "));
}

size_t naturalClips(const Workspace& workspace) {
  size_t out = 0;
  for (const MotionGroup& group : workspace.motions().groups())
    for (const Motion& motion : group.motions) out += group.natural() && motion.used ? 1 : 0;
  return out;
}

QString naturalText(const Workspace& workspace) {
  const size_t clips = naturalClips(workspace);
  if (clips == 0) return ComparisonChoice::tr("No natural motion to compare with");
  if (workspace.view().comparison() == Comparison::ThisPath)
    return clips == 1
               ? ComparisonChoice::tr("Compared with the one natural clip, on a path of its own")
               : ComparisonChoice::tr("Compared with all %1 natural clips, on paths of their own")
                     .arg(clips);
  const auto missing = workspace.sampling().withoutHeldOut();
  const QString natural =
      clips == 1
          ? ComparisonChoice::tr("Compared with the natural clip whose control is followed")
          : ComparisonChoice::tr("Compared with all %1 natural clips, whose control is followed")
                .arg(clips);
  if (missing.empty() || workspace.sampling().active()) return natural;
  return ComparisonChoice::tr("%1 · missing or out of date: %2").arg(natural, listed(missing));
}

}  // namespace

ComparisonChoice::ComparisonChoice(Workspace& workspace, const QString& name, QWidget* parent)
    : QWidget(parent), m_workspace(workspace) {
  m_choice = new QComboBox(this);
  m_choice->setObjectName(name + QStringLiteral("Compare"));
  m_choice->addItems({tr("This path"), tr("Held-out control")});
  m_choice->setToolTip(
      tr("This path: the motions that were sampled along a path. Held-out control: motions along "
         "the control of every natural clip, which is what a report counts."));
  m_choice->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  m_choice->setMinimumContentsLength(8);
  m_sample = new QPushButton(tr("Sample"), this);
  m_sample->setToolTip(tr("Samples along the control of every natural clip"));
  m_sample->setObjectName(name + QStringLiteral("HeldOut"));
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(m_choice);
  row->addWidget(m_sample);
  row->addStretch(1);
  connect(m_choice, qOverload<int>(&QComboBox::activated), this, [this](int index) {
    m_workspace.view().setComparison(static_cast<Comparison>(index));
    // Asking for the comparison is asking for its motions.
    if (m_workspace.view().comparison() == Comparison::HeldOut)
      m_workspace.sampling().sampleHeldOut();
  });
  connect(m_sample, &QPushButton::clicked, &workspace.sampling(), &Sampling::sampleHeldOut);
  connect(&workspace.view(), &View::comparisonChanged, this, &ComparisonChoice::refresh);
  connect(&workspace.motions(), &MotionGroups::changed, this, &ComparisonChoice::refresh);
  connect(&workspace.document(), &Document::changed, this, &ComparisonChoice::refresh);
  refresh();
}

QString ComparisonChoice::missingText(const Workspace& workspace) {
  const auto missing = workspace.sampling().withoutHeldOut();
  if (naturalClips(workspace) == 0)
    return tr("Held-out control is that of natural clips, and the document has none.");
  if (workspace.sampling().active()) return tr("Sampling along the control of every natural clip…");
  if (missing.empty()) return tr("The document has no model that is ticked in Sampling.");
  return tr("No motions along held-out control yet: press “Sample” above (%1).")
      .arg(listed(missing));
}

std::vector<std::string> ComparisonChoice::notes(const Workspace& workspace,
                                                 std::vector<std::string> others) {
  others.insert(others.begin(), naturalText(workspace).toStdString());
  return others;
}

void ComparisonChoice::refresh() {
  const bool heldOut = m_workspace.view().comparison() == Comparison::HeldOut;
  m_choice->setCurrentIndex(static_cast<int>(m_workspace.view().comparison()));
  m_sample->setVisible(heldOut);
  m_sample->setEnabled(!m_workspace.sampling().active() && naturalClips(m_workspace) > 0 &&
                       !m_workspace.sampling().withoutHeldOut().empty());
}

}  // namespace marey::gui
