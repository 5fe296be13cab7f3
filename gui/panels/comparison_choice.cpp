#include "panels/comparison_choice.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>

#include "shell/workspace.h"

namespace marey::gui {
namespace {

QString listed(const std::vector<std::string>& names) {
  QStringList out;
  for (const std::string& name : names) out << QString::fromStdString(name);
  return out.join(QStringLiteral(", "));
}

size_t naturalClips(const Workspace& workspace) {
  size_t out = 0;
  for (const MotionGroup& group : workspace.groups())
    if (group.natural()) out += group.motions.size();
  return out;
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
  m_sample = new QPushButton(tr("Sample held-out control"), this);
  m_sample->setObjectName(name + QStringLiteral("HeldOut"));
  m_natural = new QLabel(this);
  m_natural->setObjectName(name + QStringLiteral("Natural"));
  m_natural->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(m_choice);
  row->addWidget(m_sample);
  row->addWidget(m_natural, 1);
  connect(m_choice, qOverload<int>(&QComboBox::activated), this, [this](int index) {
    m_workspace.setComparison(static_cast<Comparison>(index));
    // Asking for the comparison is asking for its motions.
    if (m_workspace.comparison() == Comparison::HeldOut) m_workspace.sampleHeldOut();
  });
  connect(m_sample, &QPushButton::clicked, &workspace, &Workspace::sampleHeldOut);
  for (const auto changed :
       {&Workspace::comparisonChanged, &Workspace::motionsChanged, &Workspace::documentChanged})
    connect(&workspace, changed, this, &ComparisonChoice::refresh);
  refresh();
}

QString ComparisonChoice::missingText(const Workspace& workspace) {
  const auto missing = workspace.withoutHeldOut();
  if (naturalClips(workspace) == 0)
    return tr("Held-out control is that of natural clips, and the document has none.");
  if (workspace.sampling()) return tr("Sampling along the control of every natural clip…");
  if (missing.empty()) return tr("The document has no model that is ticked in Sampling.");
  return tr("No motions along held-out control yet: press “Sample held-out control” (%1).")
      .arg(listed(missing));
}

QString ComparisonChoice::naturalText() const {
  const size_t clips = naturalClips(m_workspace);
  if (clips == 0) return tr("No natural motion to compare with");
  if (m_workspace.comparison() == Comparison::ThisPath)
    return clips == 1 ? tr("Compared with the one natural clip, on a path of its own")
                      : tr("Compared with all %1 natural clips, on paths of their own").arg(clips);
  const auto missing = m_workspace.withoutHeldOut();
  const QString natural =
      clips == 1 ? tr("Compared with the natural clip whose control is followed")
                 : tr("Compared with all %1 natural clips, whose control is followed").arg(clips);
  if (missing.empty() || m_workspace.sampling()) return natural;
  return tr("%1 · missing or out of date: %2").arg(natural, listed(missing));
}

void ComparisonChoice::refresh() {
  const bool heldOut = m_workspace.comparison() == Comparison::HeldOut;
  m_choice->setCurrentIndex(static_cast<int>(m_workspace.comparison()));
  m_sample->setVisible(heldOut);
  m_sample->setEnabled(!m_workspace.sampling() && naturalClips(m_workspace) > 0 &&
                       !m_workspace.withoutHeldOut().empty());
  m_natural->setText(naturalText());
  m_natural->setToolTip(naturalText());
}

}  // namespace marey::gui
