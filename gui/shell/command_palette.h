// Every command of the menus by a few letters of its name (Ctrl+P).
#pragma once

#include <QAction>
#include <QDialog>
#include <vector>

class QLineEdit;
class QListWidget;

namespace marey::gui {

/// How well `text` holds the letters of `query` in order: higher is better, negative is no match.
int matchScore(const QString& text, const QString& query);

class CommandPalette : public QDialog {
  Q_OBJECT
 public:
  CommandPalette(std::vector<QAction*> actions, QWidget* parent);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void filter(const QString& query);
  void run();

  std::vector<QAction*> m_actions;
  QLineEdit* m_query;
  QListWidget* m_list;
};

}  // namespace marey::gui
