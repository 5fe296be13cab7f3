#include "panels/commands.h"

#include "panels/document_settings.h"
#include "panels/export_dialog.h"
#include "panels/import_dialog.h"

namespace marey::gui {

void addPanelCommands(MainWindow& window, Workspace& workspace) {
  window.addCommand(QObject::tr("File"), QStringLiteral("exportMotions"),
                    QObject::tr("Export motions…"), QObject::tr("Ctrl+E"),
                    [&window, &workspace] { showExportDialog(workspace, &window); });
  window.addCommand(QObject::tr("Edit"), QStringLiteral("documentSettings"),
                    QObject::tr("Document settings…"), QObject::tr("Ctrl+,"),
                    [&window, &workspace] { showDocumentSettings(workspace, &window); });
  window.setImporter([&window, &workspace](const QStringList& files) {
    showImportDialog(workspace, files, &window);
  });
}

}  // namespace marey::gui
