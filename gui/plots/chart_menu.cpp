// A chart out of the window: files and the clipboard.
#include <QApplication>
#include <QClipboard>
#include <QContextMenuEvent>
#include <QMenu>

#include "gui/plots/chart_files.h"
#include "gui/plots/chart_out.h"
#include "gui/plots/chart_view.h"

namespace marey::gui {

void ChartView::saveAs(const QString& file) const {
  const render::ChartSize size{static_cast<double>(std::max(width(), 480)),
                               static_cast<double>(std::max(height(), 240))};
  render::ChartGrid paper = shownGrid();
  paper.theme = {};
  saveChart(paper, size, m_recipe, file.toStdString());
}

void ChartView::copyPicture() const {
  if (!drawable()) return;
  render::ChartGrid paper = shownGrid();
  paper.theme = {};
  const render::Image image =
      render::drawImage(paper, {static_cast<double>(width()), static_cast<double>(height())}, 2.0);
  const QImage view(image.pixels.data(), image.width, image.height, 4 * image.width,
                    QImage::Format_RGBA8888);
  QApplication::clipboard()->setImage(view.copy());
}

void ChartView::contextMenuEvent(QContextMenuEvent* event) {
  if (!drawable()) return;
  QMenu menu;
  menu.setObjectName(QStringLiteral("chartMenu"));
  addSaveActions(
      menu, *this, m_fileStem, [this](const QString& file) { saveAs(file); },
      [this](const QString& error) { Q_EMIT saveFailed(error); });
  menu.addSeparator();
  menu.addAction(tr("Copy picture"), this, [this] { copyPicture(); })
      ->setObjectName(QStringLiteral("chartCopy"));
  QAction* reset = menu.addAction(tr("Show the whole axis"), this, [this] { resetZoom(); });
  reset->setObjectName(QStringLiteral("chartResetZoom"));
  reset->setEnabled(zoomed());
  menu.exec(event->globalPos());
}

}  // namespace marey::gui
