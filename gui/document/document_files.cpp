#include "gui/document/document_files.h"

#include <QDateTime>
#include <QDir>
#include <QFileInfo>
#include <QSettings>
#include <QStandardPaths>
#include <QUuid>

#include "base/atomic_file.h"
#include "base/error.h"
#include "experiment/demo_resources.h"

namespace marey::gui {
namespace {

constexpr int kAutosaveMs = 2000;
constexpr int kMostRecent = 10;

QString dataFolder(const QString& name) {
  const QString folder =
      QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation) + u'/' + name;
  QDir().mkpath(folder);
  return folder;
}

QString autosaveFolder() {
  return dataFolder(QStringLiteral("autosave"));
}

}  // namespace

Experiment demoDocument() {
  const std::filesystem::path folder = dataFolder(QStringLiteral("demo")).toStdString();
  const auto write = [&](const char* name, std::string_view content) {
    std::error_code none;
    // Another window may be reading the model, and its weights are known by the time of writing.
    const bool there =
        std::filesystem::is_regular_file(folder / name, none) && readFile(folder / name) == content;
    if (!there) writeFileAtomically(folder / name, content);
  };
  write("demo.marey", demoModel());
  Experiment out = experimentFromJson(Json::parse(demoExperiment()), "the demonstration");
  out.folder = folder;
  return out;
}

Autosave::Autosave(Workspace& workspace, QObject* parent)
    : QObject(parent), m_workspace(workspace) {
  m_path = autosaveFolder() + u'/' + QUuid::createUuid().toString(QUuid::WithoutBraces) +
           QStringLiteral(".json");
  m_lock = std::make_unique<QLockFile>(m_path + QStringLiteral(".lock"));
  m_lock->setStaleLockTime(0);
  m_lock->tryLock(0);
  m_timer.setSingleShot(true);
  m_timer.setInterval(kAutosaveMs);
  connect(&m_timer, &QTimer::timeout, this, &Autosave::write);
  connect(&m_workspace.document(), &Document::changed, this, [this] {
    if (m_workspace.modified())
      m_timer.start();
    else
      remove();
  });
}

Autosave::~Autosave() {
  remove();
}

bool Autosave::write() {
  const Experiment e = m_workspace.toWrite();
  const Json copy = {{"file", m_workspace.document().file().toStdString()},
                     {"folder", e.folder.string()},
                     {"experiment", toJson(e)}};
  try {
    writeJson(m_path.toStdString(), copy);
    m_failed = false;
  } catch (const Error& error) {
    if (!m_failed)
      m_workspace.report(tr("Keeping a copy of unsaved work"),
                         QString::fromStdString(error.what()));
    m_failed = true;
  }
  return !m_failed;
}

void Autosave::remove() {
  m_timer.stop();
  QFile::remove(m_path);
}

Recovery Autosave::recover() {
  Recovery out;
  const QDir folder(autosaveFolder());
  for (const QFileInfo& info : folder.entryInfoList({QStringLiteral("*.json")}, QDir::Files)) {
    const QString path = info.filePath();
    auto lock = std::make_shared<QLockFile>(path + QStringLiteral(".lock"));
    lock->setStaleLockTime(0);
    if (!lock->tryLock(0)) continue;  // its window is alive, or another one is asking about it
    try {
      const Json copy = readJson(path.toStdString());
      JsonReader reader(copy, path.toStdString());
      Recovered one{.experiment = experimentFromJson(reader.raw("experiment"), reader.origin()),
                    .file = QString::fromStdString(reader.required<std::string>("file")),
                    .when = info.lastModified().toString(Qt::ISODate),
                    .copy = path,
                    .lock = std::move(lock)};
      one.experiment.folder = reader.required<std::string>("folder");
      reader.finish();
      out.kept.push_back(std::move(one));
    } catch (const Error& error) {
      const QString aside = path + QStringLiteral(".broken");
      QFile::remove(aside);
      QFile::rename(path, aside);
      out.broken += tr("%1\nIt is kept as %2.").arg(QString::fromStdString(error.what()), aside);
    }
  }
  return out;
}

void Autosave::discard(const Recovered& recovered) {
  QFile::remove(recovered.copy);
}

QStringList recentFiles() {
  return QSettings().value(QStringLiteral("recentFiles")).toStringList();
}

void rememberRecent(const QString& file) {
  QStringList files = recentFiles();
  const QString whole = QFileInfo(file).absoluteFilePath();
  files.removeAll(whole);
  files.prepend(whole);
  while (files.size() > kMostRecent) files.removeLast();
  QSettings().setValue(QStringLiteral("recentFiles"), files);
}

}  // namespace marey::gui
