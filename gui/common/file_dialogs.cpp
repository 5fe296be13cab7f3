#include "gui/common/file_dialogs.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>

namespace marey::gui {

QString askSaveFile(QWidget* parent, const QString& title, const QString& start,
                    const QString& filter, const QString& suffix) {
  QFileDialog dialog(parent, title, {}, filter);
  dialog.setObjectName(QStringLiteral("saveDialog"));
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(suffix);
  const QFileInfo wanted(start);
  if (!start.isEmpty()) {
    dialog.setDirectory(wanted.absolutePath());
    dialog.selectFile(wanted.fileName());
  }
  const QString ending = u'.' + suffix;
  while (dialog.exec() == QDialog::Accepted) {
    QString file = dialog.selectedFiles().value(0);
    if (file.endsWith(ending, Qt::CaseInsensitive)) return file;
    // The dialog takes "walk.v2" for a whole name.
    file += ending;
    if (!QFileInfo::exists(file) ||
        QMessageBox::question(parent, title,
                              QObject::tr("%1 is there already. Replace it?").arg(file)) ==
            QMessageBox::Yes)
      return file;
  }
  return {};
}

}  // namespace marey::gui
