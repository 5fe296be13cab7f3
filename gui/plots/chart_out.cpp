#include "gui/plots/chart_out.h"

#include <QContextMenuEvent>
#include <algorithm>

#include "gui/common/file_dialogs.h"
#include "gui/plots/chart_files.h"

#include "base/error.h"

namespace marey::gui {

void addSaveActions(QMenu& menu, QWidget& owner, const QString& stem,
                    const std::function<void(const QString&)>& save,
                    const std::function<void(const QString&)>& failed) {
  for (const char* name : {"svg", "pdf", "png", "csv"}) {
    const QString ending = QLatin1String(name);
    const QString text = ending == QLatin1String("csv")
                             ? ChartMenu::tr("Save data as CSV...")
                             : ChartMenu::tr("Save as %1...").arg(ending.toUpper());
    const auto run = [&owner, stem, ending, save, failed] {
      const QString filter = ChartMenu::tr("%1 (*.%2)").arg(ending.toUpper(), ending);
      const QString file =
          askSaveFile(&owner, ChartMenu::tr("Save chart"), stem + "." + ending, filter, ending);
      if (file.isEmpty()) return;
      try {
        save(file);
      } catch (const Error& error) {
        failed(QString::fromStdString(error.what()));
      }
    };
    menu.addAction(text, &owner, run)->setObjectName("chartSave_" + ending);
  }
}

ChartMenu::ChartMenu(QWidget* widget, ChartOut out)
    : QObject(widget), m_widget(widget), m_out(std::move(out)) {
  widget->installEventFilter(this);
}

void ChartMenu::saveAs(const QString& file) const {
  const render::ChartGrid grid = m_out.grid();
  // Named rows need their room, which a scrolled or narrow widget may not have.
  size_t rows = 0;
  for (const render::Chart& chart : grid.charts) rows = std::max(rows, chart.y.categories.size());
  constexpr int kRowHeight = 18, kAround = 90;
  const int height = std::max(240, kAround + kRowHeight * static_cast<int>(rows));
  const render::ChartSize size{static_cast<double>(std::max(m_widget->width(), 480)),
                               static_cast<double>(std::max(m_widget->height(), height))};
  saveChart(grid, size, m_out.recipe(), file.toStdString());
}

bool ChartMenu::eventFilter(QObject* object, QEvent* event) {
  if (object != m_widget || event->type() != QEvent::ContextMenu) return false;
  if (m_out.grid().charts.empty()) return false;
  QMenu menu;
  menu.setObjectName(QStringLiteral("chartMenu"));
  addSaveActions(
      menu, *m_widget, m_out.stem, [this](const QString& file) { saveAs(file); }, m_out.failed);
  menu.exec(static_cast<QContextMenuEvent*>(event)->globalPos());
  return true;
}

}  // namespace marey::gui
