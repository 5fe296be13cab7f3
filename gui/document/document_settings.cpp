#include "gui/document/document_settings.h"

#include <QDialog>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QSpinBox>
#include <limits>

#include "gui/common/number_box.h"

namespace marey::gui {
namespace {

class DocumentSettings : public QDialog {
 public:
  DocumentSettings(Workspace& workspace, QWidget* parent)
      : QDialog(parent), m_workspace(workspace) {
    setObjectName(QStringLiteral("documentSettings"));
    setAttribute(Qt::WA_DeleteOnClose);
    setWindowTitle(tr("Document settings"));
    setModal(true);
    auto* form = new QFormLayout(this);
    buildText(*form);
    buildNumbers(*form);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
    connect(buttons, &QDialogButtonBox::accepted, this, &DocumentSettings::take);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    form->addRow(buttons);
    resize(520, 420);
  }

 private:
  void buildText(QFormLayout& form) {
    const Experiment& e = m_workspace.document().experiment();
    m_title = new QLineEdit(QString::fromStdString(e.title), this);
    m_title->setObjectName(QStringLiteral("settingsTitle"));
    m_notes = new QPlainTextEdit(QString::fromStdString(e.notes), this);
    m_notes->setObjectName(QStringLiteral("settingsNotes"));
    m_notes->setToolTip(tr("Stands in the report, below its title"));
    m_notes->setTabChangesFocus(true);
    m_feet = new QLineEdit(QString::fromStdString(e.feet), this);
    m_feet->setObjectName(QStringLiteral("settingsFeet"));
    m_feet->setPlaceholderText(tr("found by name"));
    m_feet->setToolTip(tr("Joints whose contacts with the floor are counted: names with commas"));
    form.addRow(tr("Title"), m_title);
    form.addRow(tr("Notes"), m_notes);
    form.addRow(tr("Feet"), m_feet);
  }

  void buildNumbers(QFormLayout& form) {
    const Experiment& e = m_workspace.document().experiment();
    m_fps = new NumberBox(this);
    m_fps->setObjectName(QStringLiteral("settingsFps"));
    m_fps->setRange(1.0, 1000.0);
    m_fps->setDecimals(3);
    m_fps->setSuffix(tr(" frames/s"));
    m_fps->setValue(e.fps);
    m_fps->setToolTip(tr("Natural motion is brought to it, and models must have it"));
    m_heldOut = new CountBox(this);
    m_heldOut->setObjectName(QStringLiteral("settingsHeldOut"));
    m_heldOut->setRange(0, std::numeric_limits<int>::max());
    m_heldOut->setValue(e.heldOutSamples);
    m_heldOut->setToolTip(tr("Samples of the report along the way of each natural clip; 0: none"));
    m_step = new NumberBox(this);
    m_step->setObjectName(QStringLiteral("settingsToleranceStep"));
    m_step->setRange(0.01, 100.0);
    m_step->setSingleStep(0.1);
    m_step->setSuffix(tr(" cm/s"));
    m_step->setValue(e.toleranceStepCmS);
    m_step->setToolTip(
        tr("Between the tolerances at which footsteps are counted: 1.0 for human heels, 0.3 for a "
           "dog's toes"));
    m_shownFps = m_fps->value();
    m_shownStep = m_step->value();
    form.addRow(tr("Frame rate"), m_fps);
    form.addRow(tr("Held-out samples"), m_heldOut);
    form.addRow(tr("Tolerance step"), m_step);
  }

  void take() {
    m_workspace.document().edit(tr("Document settings"), [this](Experiment& e) {
      e.title = m_title->text().toStdString();
      e.notes = m_notes->toPlainText().toStdString();
      e.feet = m_feet->text().trimmed().toStdString();
      // A box rounds: what was not touched keeps all its digits.
      if (m_fps->value() != m_shownFps) e.fps = m_fps->value();
      if (m_step->value() != m_shownStep) e.toleranceStepCmS = m_step->value();
      e.heldOutSamples = m_heldOut->value();
    });
    accept();
  }

  Workspace& m_workspace;
  QLineEdit* m_title = nullptr;
  QPlainTextEdit* m_notes = nullptr;
  QLineEdit* m_feet = nullptr;
  QDoubleSpinBox* m_fps = nullptr;
  QSpinBox* m_heldOut = nullptr;
  QDoubleSpinBox* m_step = nullptr;
  double m_shownFps = 0.0, m_shownStep = 0.0;
};

}  // namespace

void showDocumentSettings(Workspace& workspace, QWidget* parent) {
  (new DocumentSettings(workspace, parent))->show();
}

}  // namespace marey::gui
