#include "gui/shell/command_palette.h"

#include <QKeyEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QVBoxLayout>
#include <algorithm>

namespace marey::gui {
namespace {

QString plainText(const QAction& action) {
  QString text = action.text();
  text.remove(QLatin1Char('&')).remove(QStringLiteral("…"));
  const QString menu = action.property("menu").toString();
  return menu.isEmpty() ? text : menu + QStringLiteral(": ") + text;
}

}  // namespace

int matchScore(const QString& text, const QString& query) {
  int score = 0, from = 0, last = -2;
  for (const QChar letter : query) {
    if (letter.isSpace()) continue;
    const int at = static_cast<int>(text.indexOf(letter, from, Qt::CaseInsensitive));
    if (at < 0) return -1;
    const bool wordStart = at == 0 || !text.at(at - 1).isLetterOrNumber();
    score += at == last + 1 ? 3 : wordStart ? 2 : 0;
    last = at;
    from = at + 1;
  }
  return score;
}

CommandPalette::CommandPalette(std::vector<QAction*> actions, QWidget* parent)
    : QDialog(parent, Qt::Popup | Qt::FramelessWindowHint), m_actions(std::move(actions)) {
  setObjectName(QStringLiteral("commandPalette"));
  m_query = new QLineEdit(this);
  m_query->setObjectName(QStringLiteral("commandQuery"));
  m_query->setPlaceholderText(tr("Type a command"));
  m_list = new QListWidget(this);
  m_list->setObjectName(QStringLiteral("commandList"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 8, 8, 8);
  layout->addWidget(m_query);
  layout->addWidget(m_list);
  connect(m_query, &QLineEdit::textChanged, this, &CommandPalette::filter);
  connect(m_query, &QLineEdit::returnPressed, this, &CommandPalette::run);
  connect(m_list, &QListWidget::itemActivated, this, &CommandPalette::run);
  m_query->installEventFilter(this);
  filter({});
  resize(520, 360);
  m_query->setFocus();
}

bool CommandPalette::eventFilter(QObject* watched, QEvent* event) {
  if (watched == m_query && event->type() == QEvent::KeyPress) {
    const int key = static_cast<QKeyEvent*>(event)->key();
    const int step = key == Qt::Key_Down ? 1 : key == Qt::Key_Up ? -1 : 0;
    if (step != 0) {
      m_list->setCurrentRow(std::clamp(m_list->currentRow() + step, 0, m_list->count() - 1));
      return true;
    }
  }
  return QDialog::eventFilter(watched, event);
}

void CommandPalette::filter(const QString& query) {
  std::vector<std::pair<int, QAction*>> found;
  for (QAction* action : m_actions) {
    const int score = matchScore(plainText(*action), query);
    if (score >= 0 && action->isEnabled()) found.emplace_back(score, action);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  m_list->clear();
  for (const auto& [score, action] : found) {
    QString text = plainText(*action);
    const QString keys = action->shortcut().toString(QKeySequence::NativeText);
    if (!keys.isEmpty()) text += QStringLiteral("    ") + keys;
    auto* item = new QListWidgetItem(text, m_list);
    item->setData(Qt::UserRole, QVariant::fromValue(static_cast<void*>(action)));
  }
  m_list->setCurrentRow(0);
}

void CommandPalette::run() {
  const QListWidgetItem* item = m_list->currentItem();
  if (item == nullptr) return;
  auto* action = static_cast<QAction*>(item->data(Qt::UserRole).value<void*>());
  accept();
  action->trigger();
}

}  // namespace marey::gui
