#include "gui/shell/commands.h"

#include "gui/document/document_settings.h"
#include "gui/exchange/export_dialog.h"
#include "gui/exchange/import_dialog.h"

namespace marey::gui {

void addPanelCommands(MainWindow& window, Workspace& workspace) {
  window.menus().addCommand(
      QObject::tr("File"), QStringLiteral("exportMotions"), QObject::tr("Export motions…"),
      QObject::tr("Ctrl+E"),
      [&window, &workspace] { showExportDialog(workspace, window.shownScene(), &window); });
  window.menus().addCommand(QObject::tr("Edit"), QStringLiteral("documentSettings"),
                            QObject::tr("Document settings…"), QObject::tr("Ctrl+,"),
                            [&window, &workspace] { showDocumentSettings(workspace, &window); });
  window.menus().addCommand(
      QObject::tr("File"), QStringLiteral("scenePicture"), QObject::tr("Picture of the 3D view…"),
      QKeySequence(Qt::Key_P),
      [&window, &workspace] { saveScenePicture(workspace, *window.shownScene(), &window); });
  window.files().setImporter([&window, &workspace](const QStringList& files) {
    showImportDialog(workspace, files, &window);
  });
}

}  // namespace marey::gui
