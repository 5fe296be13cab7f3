// How a plot gets out of the window: the menu with its files.
#pragma once

#include <QMenu>
#include <QObject>
#include <QString>
#include <QWidget>
#include <functional>

#include "render/chart/chart.h"

namespace marey::gui {

/// Adds "Save as SVG...", PDF, PNG and CSV. `save` writes the chosen file and may throw Error,
/// whose text goes to `failed`.
void addSaveActions(QMenu& menu, QWidget& owner, const QString& stem,
                    const std::function<void(const QString& file)>& save,
                    const std::function<void(const QString& error)>& failed);

/// A plot that paints itself, as a chart of the same data.
struct ChartOut {
  std::function<render::ChartGrid()> grid;  ///< on light ground; without charts there is no menu
  std::function<render::Recipe()> recipe;
  QString stem;  ///< proposed name of files, without ending
  std::function<void(const QString& error)> failed;
};

/// Gives a widget the menu of charts; lives as long as the widget.
class ChartMenu : public QObject {
  Q_OBJECT
 public:
  ChartMenu(QWidget* widget, ChartOut out);
  /// .svg, .pdf, .png or .csv. Throws UsageError, FileError.
  void saveAs(const QString& file) const;

 protected:
  bool eventFilter(QObject* object, QEvent* event) override;

 private:
  QWidget* m_widget;
  ChartOut m_out;
};

}  // namespace marey::gui
