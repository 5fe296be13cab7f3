#include "gui/document/history_panel.h"

#include <QListWidget>
#include <QVBoxLayout>

namespace marey::gui {
namespace {

class HistoryPanel : public QWidget {
 public:
  HistoryPanel(Workspace& workspace, QWidget* parent) : QWidget(parent), m_workspace(workspace) {
    m_list = new QListWidget(this);
    m_list->setObjectName(QStringLiteral("historyList"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(6, 6, 6, 6);
    layout->addWidget(m_list);
    connect(&workspace.document(), &Document::changed, this, &HistoryPanel::refresh);
    connect(m_list, &QListWidget::currentRowChanged, this, [this](int row) {
      if (!m_refreshing && row >= 0) m_workspace.document().goToEdit(static_cast<size_t>(row));
    });
    refresh();
  }

 private:
  void refresh() {
    m_refreshing = true;
    const auto& history = m_workspace.document().history();
    m_list->clear();
    for (size_t i = 0; i < history.size(); ++i) {
      auto* item = new QListWidgetItem(QString::fromStdString(history.label(i)), m_list);
      // What was undone and would come back by redo.
      if (i > history.index()) item->setForeground(palette().placeholderText());
    }
    m_list->setCurrentRow(static_cast<int>(history.index()));
    m_refreshing = false;
  }

  Workspace& m_workspace;
  QListWidget* m_list;
  bool m_refreshing = false;
};

}  // namespace

QWidget* makeHistoryPanel(Workspace& workspace, QWidget* parent) {
  return new HistoryPanel(workspace, parent);
}

}  // namespace marey::gui
