// A chart out of the window: files and the clipboard.
#include <QApplication>
#include <QClipboard>
#include <QContextMenuEvent>
#include <QMenu>

#include "plots/chart_files.h"
#include "plots/chart_view.h"
#include "shell/file_dialogs.h"

#include "base/error.h"

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

void ChartView::saveWithDialog(const QString& ending) {
  const QString file = askSaveFile(this, tr("Save chart"), m_fileStem + "." + ending,
                                   tr("%1 (*.%2)").arg(ending.toUpper(), ending), ending);
  if (file.isEmpty()) return;
  try {
    saveAs(file);
  } catch (const Error& error) {
    Q_EMIT saveFailed(QString::fromStdString(error.what()));
  }
}

void ChartView::contextMenuEvent(QContextMenuEvent* event) {
  if (!drawable()) return;
  QMenu menu;
  menu.setObjectName(QStringLiteral("chartMenu"));
  for (const char* ending : {"svg", "pdf", "png", "csv"}) {
    const QString name = QString::fromLatin1(ending);
    const QString text =
        name == "csv" ? tr("Save data as CSV...") : tr("Save as %1...").arg(name.toUpper());
    menu.addAction(text, this, [this, name] { saveWithDialog(name); })
        ->setObjectName("chartSave_" + name);
  }
  menu.addSeparator();
  menu.addAction(tr("Copy picture"), this, [this] { copyPicture(); })
      ->setObjectName(QStringLiteral("chartCopy"));
  QAction* reset = menu.addAction(tr("Show the whole axis"), this, [this] { resetZoom(); });
  reset->setObjectName(QStringLiteral("chartResetZoom"));
  reset->setEnabled(zoomed());
  menu.exec(event->globalPos());
}

}  // namespace marey::gui
