#include "gui/shell/offer_bar.h"

#include <QLabel>
#include <QPushButton>

#include "gui/workspace/workspace.h"

namespace marey::gui {

OfferBar::OfferBar(Workspace& workspace, QWidget* parent)
    : QToolBar(parent), m_workspace(workspace) {
  setObjectName(QStringLiteral("offerBar"));
  setWindowTitle(tr("Sample again"));
  setMovable(false);
  toggleViewAction()->setVisible(false);
  m_text = new QLabel(this);
  m_text->setObjectName(QStringLiteral("offerText"));
  m_text->setMargin(6);
  auto* sample = new QPushButton(tr("Sample again"), this);
  sample->setObjectName(QStringLiteral("offerSample"));
  auto* dismiss = new QPushButton(tr("Leave them out"), this);
  dismiss->setObjectName(QStringLiteral("offerDismiss"));
  dismiss->setToolTip(tr("The document forgets these sets"));
  addWidget(m_text);
  addWidget(sample);
  addWidget(dismiss);
  connect(sample, &QPushButton::clicked, &workspace.kept(), &KeptSets::sampleOffered);
  connect(dismiss, &QPushButton::clicked, &workspace.kept(), &KeptSets::dismissOffered);
  connect(&workspace.kept(), &KeptSets::offeredChanged, this, &OfferBar::refresh);
  refresh();
}

void OfferBar::refresh() {
  const auto& sets = m_workspace.kept().offered();
  QStringList names;
  constexpr size_t kNamed = 3;
  for (size_t i = 0; i < sets.size() && i < kNamed; ++i)
    names << QString::fromStdString(sets[i].system.name + " – " + sets[i].path.name);
  if (sets.size() > kNamed) names << tr("%1 more").arg(sets.size() - kNamed);
  m_text->setText(sets.size() == 1
                      ? tr("This document was saved with a sample set: %1.").arg(names.front())
                      : tr("This document was saved with %1 sample sets: %2.")
                            .arg(sets.size())
                            .arg(names.join(QStringLiteral(", "))));
  setVisible(!sets.empty());
}

}  // namespace marey::gui
