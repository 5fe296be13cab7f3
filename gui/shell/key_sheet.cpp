#include "gui/shell/key_sheet.h"

#include <QDialog>
#include <QTextBrowser>
#include <QVBoxLayout>

namespace marey::gui {

void showKeySheet(const std::vector<QAction*>& commands, const QStringList& lines,
                  QWidget* parent) {
  QString rows;
  const auto row = [&rows](const QString& keys, const QString& what) {
    rows += QStringLiteral(
                "<tr><td style='padding:3px 24px 3px 0'><b>%1</b></td><td "
                "style='padding:3px 0'>%2</td></tr>")
                .arg(keys.toHtmlEscaped(), what.toHtmlEscaped());
  };
  for (const QAction* action : commands)
    if (!action->shortcut().isEmpty())
      row(action->shortcut().toString(QKeySequence::NativeText), action->text().remove(u'&'));
  for (const QString& line : lines) row(line.section(u'\t', 0, 0), line.section(u'\t', 1));
  auto* sheet = new QDialog(parent);
  sheet->setObjectName(QStringLiteral("keySheet"));
  sheet->setAttribute(Qt::WA_DeleteOnClose);
  sheet->setWindowTitle(QObject::tr("Keys"));
  auto* text = new QTextBrowser(sheet);
  text->setHtml(QStringLiteral("<table>%1</table>").arg(rows));
  auto* layout = new QVBoxLayout(sheet);
  layout->addWidget(text);
  sheet->resize(560, 620);
  sheet->show();
}

}  // namespace marey::gui
