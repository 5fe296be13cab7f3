#include "shell/document_files.h"

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
    // Another window may be reading the model.
    if (std::filesystem::file_size(folder / name, none) != content.size() || none)
      writeFileAtomically(folder / name, content);
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
  connect(&m_workspace, &Workspace::documentChanged, this, [this] {
    if (m_workspace.modified())
      m_timer.start();
    else
      remove();
  });
}

Autosave::~Autosave() {
  remove();
}

void Autosave::write() {
  const Experiment& e = m_workspace.experiment();
  const Json copy = {{"file", m_workspace.file().toStdString()},
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
}

void Autosave::remove() {
  m_timer.stop();
  QFile::remove(m_path);
}

std::vector<Recovered> Autosave::recover() {
  std::vector<Recovered> out;
  const QDir folder(autosaveFolder());
  for (const QFileInfo& info : folder.entryInfoList({QStringLiteral("*.json")}, QDir::Files)) {
    QLockFile lock(info.filePath() + QStringLiteral(".lock"));
    lock.setStaleLockTime(0);
    if (!lock.tryLock(0)) continue;  // its window is alive
    try {
      const Json copy = readJson(info.filePath().toStdString());
      JsonReader reader(copy, info.filePath().toStdString());
      Recovered one{.experiment = experimentFromJson(reader.raw("experiment"), reader.origin())};
      one.experiment.folder = reader.required<std::string>("folder");
      one.file = QString::fromStdString(reader.required<std::string>("file"));
      one.when = info.lastModified().toString(Qt::ISODate);
      out.push_back(std::move(one));
    } catch (const Error&) {
      // Cut off in the middle of the crash: nothing in it can be had back.
    }
    QFile::remove(info.filePath());
  }
  return out;
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
