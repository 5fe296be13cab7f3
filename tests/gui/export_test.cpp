// What the export dialog writes, as a person asks for it, and the same from the command line.
#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QProcess>
#include <QPushButton>
#include <QRadioButton>
#include <QSpinBox>
#include <QTableWidget>
#include <QTest>
#include <QTimer>
#include <fstream>

#include "gui/exchange/export_dialog.h"
#include "gui/gui_support.h"
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/json.h"
#include "io/clip_io.h"
#include "render/base/image.h"
#include "report/motion_export.h"

namespace marey::gui {
namespace {

namespace fs = std::filesystem;

QString runProgram(const QString& program, const QStringList& arguments) {
  QProcess process;
  process.start(program, arguments);
  EXPECT_TRUE(process.waitForFinished(120000));
  EXPECT_EQ(process.exitCode(), 0) << process.readAllStandardError().toStdString();
  return QString::fromUtf8(process.readAllStandardOutput());
}

void expectSamePositions(const Clip& a, const Clip& b, float tolerance) {
  ASSERT_EQ(a.positions.size(), b.positions.size());
  for (size_t k = 0; k < a.positions.size(); ++k)
    ASSERT_LT((a.positions[k] - b.positions[k]).norm(), tolerance) << k;
}

class Export : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    openWindow();
    openSmallDemo();
    m_workspace->sampling().sampleCurrentPath();
    // The last motions are handed over after the job's end.
    ASSERT_TRUE(waitUntil([this] {
      return m_jobs->idle() && m_workspace->motions().groups().back().motions.size() == 2U;
    }));
    const MotionGroup& samples = m_workspace->motions().groups().back();
    m_workspace->view().select({.motions = {{samples.id, 0}, {samples.id, 1}}});
    settle();
    m_out = fs::path(m_folder.path().toStdString()) / "out";
    fs::create_directory(m_out);
    showExportDialog(*m_workspace, m_window->shownScene(), m_window.get());
    m_dialog = child<QDialog>(*m_window, "exportDialog");
    child<QLineEdit>(*m_dialog, "exportFolder")->setText(QString::fromStdString(m_out));
    child<QSpinBox>(*m_dialog, "exportWidth")->setValue(160);
    child<QSpinBox>(*m_dialog, "exportHeight")->setValue(120);
    child<QDoubleSpinBox>(*m_dialog, "exportFps")->setValue(10.0);
  }
  void choose(ExportFormat format) {
    auto* box = child<QComboBox>(*m_dialog, "exportFormat");
    box->setCurrentIndex(box->findData(static_cast<int>(format)));
  }
  void press() {
    auto* run = child<QPushButton>(*m_dialog, "exportRun");
    ASSERT_TRUE(run->isEnabled());
    QTest::mouseClick(run, Qt::LeftButton);
    ASSERT_TRUE(idle());
    settle(50);
  }
  /// Presses Export and answers the question that comes; empty where none came.
  QString pressAndAnswer(QMessageBox::StandardButton answer) {
    QString asked;
    QTimer::singleShot(200, m_dialog, [&asked, answer] {
      auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
      if (box == nullptr) return;
      asked = box->text();
      QTest::mouseClick(box->button(answer), Qt::LeftButton);
    });
    press();
    settle(250);
    return asked;
  }
  const Clip& shown(int index) {
    return *m_workspace->motions().groups().back().motions[index].clip;
  }
  std::string said() { return child<QLabel>(*m_dialog, "exportDone")->text().toStdString(); }
  std::vector<std::string> written() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(m_out))
      out.push_back(entry.path().filename().string());
    std::sort(out.begin(), out.end());
    return out;
  }

  fs::path m_out;
  QDialog* m_dialog = nullptr;
};

TEST_F(Export, ClipsAreThoseOfTheCommandLineForTheSameDocument) {
  choose(ExportFormat::Npz);
  press();
  ASSERT_EQ(written().size(), 2U);
  const SampleRecipe& recipe = *m_workspace->motions().groups().back().recipe;
  const fs::path cli = fs::path(m_folder.path().toStdString()) / "cli";
  runProgram(
      MAREY_BINARY,
      {"sample", QString::fromStdString(m_workspace->document().modelFile(recipe.system)), "--path",
       QString::fromStdString(recipe.path.path), "--seconds", "2", "-n", "2", "--seed",
       QString::number(recipe.seed), "--temperature", QString::number(recipe.system.temperature),
       "--format", "npz", "--out", QString::fromStdString(cli), "--quiet"});
  for (int i = 0; i < 2; ++i) {
    const Clip here = io::readClip(m_out / written()[i]);
    expectSamePositions(here, shown(i), 1e-6F);
    expectSamePositions(here, io::readClip(cli / fmt::format("sample_{:03}.npz", i)), 1e-5F);
  }
}

TEST_F(Export, APictureOfTheViewHasItsLegendUnlessToldOtherwise) {
  choose(ExportFormat::Still);
  child<QSpinBox>(*m_dialog, "exportWidth")->setValue(640);
  child<QSpinBox>(*m_dialog, "exportHeight")->setValue(360);
  press();
  ASSERT_EQ(written().size(), 1U);
  const fs::path file = m_out / written().front();
  const render::Image with = render::readPng(file);
  EXPECT_NE(render::pngRecipe(readFile(file), file).find("legend"), std::string::npos);
  child<QCheckBox>(*m_dialog, "exportLegend")->setChecked(false);
  EXPECT_FALSE(pressAndAnswer(QMessageBox::Yes).isEmpty());
  const render::Image without = render::readPng(file);
  ASSERT_EQ(with.pixels.size(), without.pixels.size());
  int differing = 0;
  for (int y = 0; y < with.height; ++y)
    for (int x = 0; x < with.width; ++x)
      if (!std::equal(with.at(x, y), with.at(x, y) + 3, without.at(x, y))) {
        ++differing;
        ASSERT_LT(x, with.width / 2) << "no colour bar where bodies have their group's colour";
        ASSERT_LT(y, with.height / 3);
      }
  EXPECT_GT(differing, 500);
}

TEST_F(Export, RotationsAreFittedAsByConvertAndTheResidualIsShown) {
  choose(ExportFormat::Npz);
  press();
  const fs::path npz = m_out / written().front();
  choose(ExportFormat::Bvh);
  press();
  auto* table = child<QTableWidget>(*m_dialog, "exportResidual");
  ASSERT_TRUE(table->isVisible());
  EXPECT_EQ(table->rowCount(), shown(0).jointCount());
  EXPECT_LT(table->item(0, 1)->text().toDouble(), 5.0);
  const fs::path bvh = fs::path(npz).replace_extension(".bvh");
  const fs::path converted = m_out / "converted.bvh";
  runProgram(MAREY_BINARY, {"convert", QString::fromStdString(npz), "--out",
                            QString::fromStdString(converted), "--quiet"});
  expectSamePositions(io::readClip(bvh), io::readClip(converted), 1e-5F);
  const Json record = readJson(bvh.string() + ".recipe.json");
  EXPECT_EQ(record["experiment_hash"], experimentHash(m_workspace->document().experiment()));
  EXPECT_EQ(record["seed"], m_workspace->motions().groups().back().recipe->seed);
  EXPECT_TRUE(record.contains("fit"));
}

TEST_F(Export, EveryFormatOfClipsIsWritten) {
  const std::pair<ExportFormat, const char*> formats[] = {
      {ExportFormat::Csv, ".csv"}, {ExportFormat::Gltf, ".gltf"}, {ExportFormat::Glb, ".glb"}};
  for (const auto& [format, extension] : formats) {
    choose(format);
    press();
    const std::vector<std::string> files = written();
    EXPECT_EQ(std::count_if(files.begin(), files.end(),
                            [&](const std::string& f) { return f.ends_with(extension); }),
              2)
        << extension << ": " << said();
  }
}

TEST_F(Export, VideosHaveTheFramesRateAndSizeThatWereAskedFor) {
  // 2 s at the demonstration's 20 fps: 20 frames at 10 fps.
  const std::pair<ExportFormat, const char*> formats[] = {{ExportFormat::Mp4, "motions.mp4"},
                                                          {ExportFormat::WebM, "motions.webm"},
                                                          {ExportFormat::Gif, "motions.gif"}};
  for (const auto& [format, name] : formats) {
    choose(format);
    press();
    const QStringList told =
        runProgram("ffprobe", {"-v", "error", "-count_frames", "-show_entries",
                               "stream=width,height,r_frame_rate,nb_read_frames", "-of",
                               "default=nw=1", QString::fromStdString(m_out / name)})
            .split('\n', Qt::SkipEmptyParts);
    for (const char* line : {"width=160", "height=120", "r_frame_rate=10/1", "nb_read_frames=20"})
      EXPECT_TRUE(told.contains(QLatin1String(line)))
          << name << ": " << line << " not in " << told.join(' ').toStdString();
  }
}

TEST_F(Export, ThePictureIsWhatTheSceneShows) {
  auto* detail = m_window->findChild<QComboBox*>(QStringLiteral("sceneColourBy"));
  ASSERT_NE(detail, nullptr);
  // Colours by value are worked out beside the event loop.
  const auto coloured = [this] {
    settle();
    EXPECT_TRUE(waitUntil([this] { return m_jobs->idle(); }));
    settle();
  };
  detail->setCurrentIndex(3);  // by speed
  child<QAction>(*m_window, "sceneViewFront")->trigger();
  m_workspace->view().setTime(1.0);
  coloured();
  choose(ExportFormat::Still);
  press();
  const std::string first = readFile(m_out / "motions.png");
  const Json recipe = Json::parse(render::pngRecipe(first, "still"));
  const Json scene = Json::parse(recipe["scene"].get<std::string>());
  EXPECT_EQ(scene["colour_by"], "speed");
  EXPECT_EQ(scene["time_s"], 1.0);
  EXPECT_EQ(recipe["seed"], std::to_string(m_workspace->motions().groups().back().recipe->seed));
  EXPECT_TRUE(scene["camera"].contains("eye"));

  // Another colour, moment or camera gives another picture; the same give the same.
  const auto again = [this] {
    pressAndAnswer(QMessageBox::Yes);
    return render::decodePng(readFile(m_out / "motions.png"), "still").pixels;
  };
  const auto before = render::decodePng(first, "still").pixels;
  EXPECT_EQ(again(), before);
  detail->setCurrentIndex(0);
  coloured();
  const auto bySystem = again();
  EXPECT_NE(bySystem, before);
  m_workspace->view().setTime(0.2);
  settle();
  const auto earlier = again();
  EXPECT_NE(earlier, bySystem);
  child<QComboBox>(*m_dialog, "exportView")->setCurrentIndex(5);  // from above
  EXPECT_NE(again(), earlier);
}

TEST_F(Export, AFigureMarksTheContactsOfTheTimeline) {
  // Natural motion that walks: what stands still rests whatever the tolerance.
  m_workspace->view().select({.motions = {{m_workspace->motions().groups().front().id, 0}}});
  child<QSpinBox>(*m_dialog, "exportWidth")->setValue(480);
  child<QSpinBox>(*m_dialog, "exportHeight")->setValue(270);
  child<QComboBox>(*m_dialog, "exportLook")->setCurrentIndex(1);
  choose(ExportFormat::Still);
  auto* tolerance = child<QDoubleSpinBox>(*m_window->showPanel("timeline"), "timelineTolerance");
  std::vector<std::vector<uint8_t>> pictures;
  for (const double cmS : {1.0, 150.0}) {
    tolerance->setValue(cmS);
    pressAndAnswer(QMessageBox::Yes);
    pictures.push_back(render::decodePng(readFile(m_out / "motions.png"), "still").pixels);
  }
  EXPECT_TRUE(pictures[0] != pictures[1]);
}

TEST_F(Export, FramesAskBeforeReplacingAndAShorterOneLeavesNoRest) {
  choose(ExportFormat::PngFrames);
  child<QLineEdit>(*m_dialog, "exportName")->setText("walk");
  press();
  ASSERT_EQ(written().size(), 20U) << said();
  child<QDoubleSpinBox>(*m_dialog, "exportFps")->setValue(2.0);
  EXPECT_NE(pressAndAnswer(QMessageBox::No).toStdString().find("20"), std::string::npos);
  EXPECT_EQ(written().size(), 20U);
  EXPECT_FALSE(pressAndAnswer(QMessageBox::Yes).isEmpty());
  EXPECT_EQ(written(), (std::vector<std::string>{"walk_0000.png", "walk_0001.png", "walk_0002.png",
                                                 "walk_0003.png"}));
}

TEST(Range, HoldsTheFramesAtItsEndsAndNoneBesideAClip) {
  Clip clip;
  clip.fps = 20.0;
  clip.skeleton = std::make_shared<const Skeleton>(
      Skeleton{.names = {"root"}, .parents = {-1}, .offsets = {Vec3::Zero()}});
  clip.positions.assign(10, Vec3::Zero());
  const auto frames = [&](double begin, double end) {
    const FrameSpan span = framesIn(clip, TimeRange{begin, end});
    return span.empty() ? std::pair{0, 0} : std::pair{span.first, span.last};
  };
  EXPECT_EQ(framesIn(clip, std::nullopt).last, 10);
  EXPECT_EQ(frames(0.1, 0.3), (std::pair{2, 7}));
  EXPECT_EQ(frames(0.11, 0.29), (std::pair{3, 6}));
  EXPECT_EQ(frames(-1.0, 9.0), (std::pair{0, 10}));
  EXPECT_EQ(frames(0.5, 0.9), (std::pair{0, 0}));
}

TEST_F(Export, OnlyTheMarkedRangeIsWritten) {
  m_workspace->view().setRange(TimeRange{0.5, 1.0});
  child<QCheckBox>(*m_dialog, "exportRange")->setChecked(true);
  choose(ExportFormat::Npz);
  press();
  const Clip part = io::readClip(m_out / written().front());
  EXPECT_EQ(part.frameCount(), 11);
  EXPECT_LT((part.at(0, 0) - shown(0).at(10, 0)).norm(), 1e-6F);
  choose(ExportFormat::PngFrames);
  press();
  EXPECT_EQ(written().size(), 2U + 6U) << "0.5, 0.6, ... 1.0 s";
}

TEST_F(Export, AFolderThatIsNoFolderGivesAReadableMessageAndNothingElse) {
  std::ofstream(m_out / "file") << "in the way";
  child<QLineEdit>(*m_dialog, "exportFolder")->setText(QString::fromStdString(m_out / "file"));
  for (const ExportFormat format :
       {ExportFormat::Bvh, ExportFormat::Mp4, ExportFormat::Still, ExportFormat::PngFrames}) {
    m_errors.clear();
    choose(format);
    press();
    EXPECT_NE(said().find("Nothing was written"), std::string::npos) << said();
    ASSERT_EQ(m_errors.size(), 1U);
    EXPECT_NE(m_errors.front().find("file"), std::string::npos) << m_errors.front();
    EXPECT_EQ(written(), std::vector<std::string>{"file"});
  }
}

TEST_F(Export, AFolderWhoseParentIsClosedCanBeWritten) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::create_directory(m_out / "home");
  child<QLineEdit>(*m_dialog, "exportFolder")->setText(QString::fromStdString(m_out / "home"));
  fs::permissions(m_out, fs::perms::owner_read | fs::perms::owner_exec);
  choose(ExportFormat::Npz);
  press();
  fs::permissions(m_out, fs::perms::owner_all);
  EXPECT_EQ(std::distance(fs::directory_iterator(m_out / "home"), fs::directory_iterator()), 2)
      << said();
}

}  // namespace
}  // namespace marey::gui
