#include "gui/shell/docks.h"

#include <qtadvanceddocking/DockAreaWidget.h>
#include <qtadvanceddocking/DockManager.h>
#include <qtadvanceddocking/DockWidget.h>

namespace marey::gui {
namespace {

ads::DockWidgetArea dockArea(PanelArea area) {
  switch (area) {
    case PanelArea::Left:
      return ads::LeftDockWidgetArea;
    case PanelArea::Right:
      return ads::RightDockWidgetArea;
    case PanelArea::Plots:
    case PanelArea::Bottom:
      return ads::BottomDockWidgetArea;
    case PanelArea::Centre:
      break;
  }
  return ads::CenterDockWidgetArea;
}

ads::CDockManager* makeManager(QMainWindow& window) {
  ads::CDockManager::setConfigFlags(ads::CDockManager::DefaultOpaqueConfig);
  ads::CDockManager::setConfigFlag(ads::CDockManager::FocusHighlighting, false);
  ads::CDockManager::setConfigFlag(ads::CDockManager::DockAreaHasTabsMenuButton, false);
  ads::CDockManager::setConfigFlag(ads::CDockManager::DockAreaHasUndockButton, false);
  ads::CDockManager::setConfigFlag(ads::CDockManager::ActiveTabHasCloseButton, false);
  auto* manager = new ads::CDockManager(&window);
  manager->setStyleSheet({});  // the application's theme holds
  return manager;
}

}  // namespace

Docks::Docks(QMainWindow& window, const std::vector<PanelSpec>& panels, const Desk& desk)
    : m_manager(makeManager(window)) {
  std::map<PanelArea, ads::CDockAreaWidget*> areas;
  for (const PanelSpec& spec : panels) {
    auto* dock = new ads::CDockWidget(spec.title);
    dock->setObjectName(spec.id);
    QWidget* content = spec.make(desk, dock);
    content->setObjectName(spec.id + QStringLiteral("Panel"));
    dock->setWidget(content, ads::CDockWidget::ForceNoScrollArea);
    auto& area = areas[spec.area];
    if (area != nullptr)
      m_manager->addDockWidgetTabToArea(dock, area);
    else
      area = m_manager->addDockWidget(
          dockArea(spec.area), dock,
          spec.area == PanelArea::Plots ? areas[PanelArea::Right] : nullptr);
    m_panels[spec.id] = dock;
  }
  for (const auto& [place, area] : areas) area->setCurrentIndex(0);
  const auto size = [&](PanelArea area, const QList<int>& sizes) {
    if (areas.contains(area)) m_manager->setSplitterSizes(areas[area], sizes);
  };
  size(PanelArea::Centre, {300, 640, 560});
  size(PanelArea::Plots, {400, 300});
  size(PanelArea::Bottom, {665, 215});
  m_firstLayout = layout();
}

QWidget* Docks::show(const QString& id) {
  const auto found = m_panels.find(id);
  if (found == m_panels.end()) return nullptr;
  found->second->toggleView(true);
  found->second->setAsCurrentTab();
  return found->second->widget();
}

QByteArray Docks::layout() const {
  return m_manager->saveState();
}

void Docks::setLayout(const QByteArray& layout) {
  m_manager->restoreState(layout);
}

}  // namespace marey::gui
