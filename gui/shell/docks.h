// The panels of the window, docked: where they lie, which is in front, and how that is kept.
#pragma once

#include <QMainWindow>
#include <map>
#include <vector>

#include "gui/shell/panel.h"

namespace ads {
class CDockManager;
class CDockWidget;
}  // namespace ads

namespace marey::gui {

class Docks {
 public:
  Docks(QMainWindow& window, const std::vector<PanelSpec>& panels, const Desk& desk);

  /// Brings a panel to the front. Null where there is none of that id.
  QWidget* show(const QString& id);
  /// By their ids.
  const std::map<QString, ads::CDockWidget*>& all() const { return m_panels; }
  QByteArray layout() const;
  void setLayout(const QByteArray& layout);
  /// As it is at the first start.
  void resetLayout() { setLayout(m_firstLayout); }

 private:
  ads::CDockManager* m_manager;
  std::map<QString, ads::CDockWidget*> m_panels;
  QByteArray m_firstLayout;
};

}  // namespace marey::gui
