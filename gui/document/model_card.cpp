#include "gui/document/model_card.h"

#include <QDialog>
#include <QDialogButtonBox>
#include <QPointer>
#include <QPushButton>
#include <QTextBrowser>
#include <QVBoxLayout>

namespace marey::gui {
namespace {

QString number(double value) {
  return QString::number(value, 'g', 6);
}

void addRow(QString& text, const QString& name, const QString& value) {
  if (!value.isEmpty()) text += QStringLiteral("| %1 | %2 |\n").arg(name, value);
}

QString trainingText(const Json& provenance) {
  if (!provenance.is_object() || !provenance.contains("steps")) return {};
  return QObject::tr("%1 steps, %2 min")
      .arg(provenance.value("steps", 0.0), 0, 'f', 0)
      .arg(provenance.value("training_seconds", 0.0) / 60.0, 0, 'f', 1);
}

class CardDialog : public QDialog {
 public:
  CardDialog(Workspace& workspace, size_t system, const ModelInfo& info, const ModelAdvice& advice,
             QWidget* parent)
      : QDialog(parent) {
    const ExperimentSystem& shown = workspace.document().experiment().systems[system];
    setObjectName(QStringLiteral("modelCard"));
    setAttribute(Qt::WA_DeleteOnClose);
    setWindowTitle(tr("Model %1").arg(QString::fromStdString(shown.name)));
    auto* text = new QTextBrowser(this);
    text->setObjectName(QStringLiteral("modelCardText"));
    text->setOpenExternalLinks(true);
    text->setMarkdown(modelCardText(info, advice, workspace.document().modelFile(shown)));
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, this);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::close);
    const auto advised = advice.temperature;
    if (advised && *advised != shown.temperature) {
      auto* use = buttons->addButton(tr("Use temperature %1").arg(number(*advised)),
                                     QDialogButtonBox::ActionRole);
      use->setObjectName(QStringLiteral("modelCardUse"));
      connect(use, &QPushButton::clicked, this, [&workspace, name = shown.name, t = *advised, use] {
        const int at = workspace.document().systemIndex(name);
        if (at >= 0)
          workspace.document().edit(tr("Temperature"), [=](Experiment& e) {
            e.systems[static_cast<size_t>(at)].temperature = t;
          });
        use->setEnabled(false);
      });
    }
    auto* layout = new QVBoxLayout(this);
    layout->addWidget(text, 1);
    layout->addWidget(buttons);
    resize(680, 620);
  }
};

}  // namespace

QString modelCardText(const ModelInfo& info, const ModelAdvice& advice, const std::string& file) {
  QString out = QStringLiteral("| | |\n|---|---|\n");
  addRow(out, QObject::tr("file"), QString::fromStdString(file));
  addRow(out, QObject::tr("family"), QString::fromStdString(info.family));
  addRow(out, QObject::tr("variant"), QString::fromStdString(info.variant));
  addRow(out, QObject::tr("parameters"),
         QObject::tr("%1 million").arg(static_cast<double>(info.parameters) / 1e6, 0, 'f', 2));
  addRow(out, QObject::tr("pose and control"),
         QObject::tr("%1 and %2 values").arg(info.poseDim).arg(info.controlDim));
  addRow(out, QObject::tr("rate"), QObject::tr("%1 per second").arg(number(info.features.fps)));
  for (const ModelFact& fact : factsOf(info))
    addRow(out, QString::fromStdString(fact.name), QString::fromStdString(fact.value));
  if (info.skeleton)
    addRow(out, QObject::tr("skeleton"), QObject::tr("%1 joints").arg(info.skeleton->jointCount()));
  addRow(out, QObject::tr("training"), trainingText(info.provenance));
  addRow(out, QObject::tr("recommended temperature"),
         advice.temperature ? number(*advice.temperature) : QObject::tr("none given"));
  if (advice.card.empty())
    out += QObject::tr("\nThe model has no card, and none lies beside it.\n");
  else
    out += u'\n' + QString::fromStdString(advice.card) + u'\n';
  const QString config = QString::fromStdString(jsonText(info.config, 2));
  return out + QObject::tr("\n## Parameters\n\n```\n%1\n```\n").arg(config);
}

void showModelCard(Workspace& workspace, size_t system, QWidget* parent) {
  if (system >= workspace.document().experiment().systems.size()) return;
  const std::string file =
      workspace.document().modelFile(workspace.document().experiment().systems[system]);
  auto info = std::make_shared<ModelInfo>();
  auto advice = std::make_shared<ModelAdvice>();
  const QPointer<QWidget> owner(parent);
  workspace.jobs().start(
      Lane::Previews, QObject::tr("Reading the model's card"),
      [&workspace, file, info, advice](Progress&) {
        *info = workspace.models().model(file)->info();
        *advice = modelAdvice(file);
      },
      [&workspace, file, info, advice, system, owner] {
        const auto& systems = workspace.document().experiment().systems;
        if (!owner || system >= systems.size() ||
            workspace.document().modelFile(systems[system]) != file)
          return;
        (new CardDialog(workspace, system, *info, *advice, owner))->show();
      },
      &workspace);
}

}  // namespace marey::gui
