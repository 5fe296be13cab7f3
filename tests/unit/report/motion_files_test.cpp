// Exports, imports and training runs as the window's dialogs handle them.
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/archive.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "experiment/file_names.h"
#include "experiment/import_files.h"
#include "experiment/opened_files.h"
#include "io/clip_io.h"
#include "model/training_run.h"
#include "motion/walker.h"
#include "render/base/image.h"
#include "report/motion_export.h"

namespace marey {
namespace {
namespace fs = std::filesystem;

class PanelFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    m_folder = fs::temp_directory_path() /
               (std::string("marey_panel_files_") + std::to_string(::getpid()) + "_" +
                ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(m_folder);
    fs::create_directories(m_folder);
    SampleRecipe recipe{.system = {.name = "MG+ no. 1", .model = "a.marey", .temperature = 0.8},
                        .path = {.name = "turn left", .path = "preset:turn-left"},
                        .seed = 17};
    MotionGroup group{.id = 4, .name = "MG+ no. 1 – turn left", .system = "MG+ no. 1"};
    group.colourIndex = 0;
    group.recipe = recipe;
    group.modelHash = "abc";
    for (WalkerClip& walk : walkerDataSet(2, 1.0, 5)) {
      walk.clip.transforms.reset();  // models give positions only
      group.motions.push_back({std::make_shared<const Clip>(std::move(walk.clip)), {}, true});
    }
    m_groups = {group};
  }
  void TearDown() override { fs::remove_all(m_folder); }

  ExportRequest request(ExportFormat format) const {
    return {.format = format,
            .folder = m_folder,
            .items = exportItems({}, m_groups, {{4, 0}, {4, 1}}, std::nullopt),
            .width = 160,
            .height = 120,
            .fps = 10.0};
  }

  fs::path m_folder;
  std::vector<MotionGroup> m_groups;
};

TEST_F(PanelFiles, ExportedNamesAreSafeAndDiffer) {
  EXPECT_EQ(safeName("MG+ no. 1"), "MG_no_1");
  EXPECT_EQ(safeName("../a/b"), "a_b");
  EXPECT_EQ(safeName("∞"), "motion");
  auto twice = m_groups;
  twice.push_back(m_groups.front());
  twice.back().id = 5;
  const auto items = exportItems({}, twice, {{4, 0}, {4, 1}, {5, 0}}, std::nullopt);
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].name, "MG_no_1_turn_left_000");
  EXPECT_EQ(items[1].name, "MG_no_1_turn_left_001");
  EXPECT_EQ(items[2].name, "MG_no_1_turn_left_000_2");
}

TEST_F(PanelFiles, ExportedClipsCarryTheirRecipeAndTheResidualOfTheirFit) {
  for (const ExportFormat format : {ExportFormat::Bvh, ExportFormat::Npz, ExportFormat::Csv,
                                    ExportFormat::Gltf, ExportFormat::Glb}) {
    Progress progress;
    const ExportResult result = exportMotions(request(format), progress);
    EXPECT_TRUE(fs::exists(exportFiles(request(format)).front()));
    const bool fitted =
        format == ExportFormat::Bvh || format == ExportFormat::Gltf || format == ExportFormat::Glb;
    EXPECT_EQ(result.fit.has_value(), fitted);
    std::string all;
    for (const fs::path& file : result.files) {
      const std::string bytes = readFile(file);
      if (file.extension() == ".npz")
        for (const auto& [name, content] : parseArchive(bytes, file.string())) all += content;
      else
        all += bytes;
    }
    std::erase(all, '\0');  // NumPy has four bytes per character
    for (const char* key : {"experiment_hash", "model_hash", "seed", "temperature", "marey"})
      EXPECT_NE(all.find(key), std::string::npos) << key;
  }
}

TEST_F(PanelFiles, ExportedPicturesCarryTheirRecipe) {
  Progress progress;
  const auto files = exportMotions(request(ExportFormat::Still), progress).files;
  const std::string recipe = render::pngRecipe(readFile(files.front()), "still");
  EXPECT_NE(recipe.find("\"seed MG+ no. 1"), std::string::npos) << recipe;
  EXPECT_NE(recipe.find("MG_no_1_turn_left_001"), std::string::npos) << recipe;
  exportMotions(request(ExportFormat::PngFrames), progress);
  EXPECT_TRUE(fs::exists(m_folder / "motions_0000.png"));
}

TEST_F(PanelFiles, ACancelledExportLeavesNothing) {
  std::stop_source stop;
  stop.request_stop();
  Progress progress({}, stop.get_token());
  EXPECT_THROW(exportMotions(request(ExportFormat::Bvh), progress), CancelledError);
  EXPECT_TRUE(fs::is_empty(m_folder));
}

TEST_F(PanelFiles, OnlyOverriddenFilesAreConverted) {
  Progress progress;
  exportMotions(request(ExportFormat::Bvh), progress);
  auto files = importFiles({m_folder.string()}).files;
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(convertOverridden(files, m_folder / "converted", progress),
            std::vector<std::string>{m_folder.string()});
  EXPECT_FALSE(fs::exists(m_folder / "converted"));
  files[0].options.unit = "m";  // the file is in centimetres
  const auto sources = convertOverridden(files, m_folder / "converted", progress);
  ASSERT_EQ(sources.size(), 2u);
  EXPECT_EQ(sources[1], files[1].path);
  const Clip asFound = io::readClip(files[0].path), converted = io::readClip(sources[0]);
  EXPECT_NEAR(converted.at(0, 0).y(), 100.0F * asFound.at(0, 0).y(), 0.1F);
}

TEST_F(PanelFiles, ContentDecidesWhatAFileIsAndNoneIsDropped) {
  const auto file = [this](const char* name) { return (m_folder / name).string(); };
  writeFileAtomically(file("path.json"), R"({"waypoints": [{"x": 0, "z": 0}, {"x": 0, "z": 2}]})");
  writeFileAtomically(file("document.json"), R"({"natural": ["walker:1,2,3"]})");
  writeFileAtomically(file("broken.json"), "{");
  const OpenedFiles sorted = sortOpened({file("path.json"), file("document.json"), file("a.bvh"),
                                         file("b.marey"), file("broken.json"), file("folder")});
  EXPECT_EQ(sorted.paths, std::vector<std::string>{file("path.json")});
  EXPECT_EQ(sorted.documents,
            (std::vector<std::string>{file("document.json"), file("broken.json")}));
  EXPECT_EQ(sorted.models, std::vector<std::string>{file("b.marey")});
  EXPECT_EQ(sorted.motions, (std::vector<std::string>{file("a.bvh"), file("folder")}));
}

TEST_F(PanelFiles, AMotionOfTheRangeIsCutOnlyWhenItIsWritten) {
  const TimeRange range{0.2, 0.5};
  ExportRequest part = request(ExportFormat::Npz);
  part.items = exportItems({}, m_groups, {{4, 0}, {4, 1}}, range);
  part.range = range;
  EXPECT_EQ(part.items.front().clip, m_groups.front().motions.front().clip);
  Progress progress;
  const auto files = exportMotions(part, progress).files;
  const Clip written = io::readClip(files.front());
  const double fps = written.fps;
  EXPECT_EQ(written.frameCount(),
            static_cast<int>(0.5 * fps + 1e-9) - static_cast<int>(std::ceil(0.2 * fps - 1e-9)) + 1);
  EXPECT_TRUE(exportItems({}, m_groups, {{4, 0}}, TimeRange{50.0, 60.0}).empty());
}

TEST_F(PanelFiles, ALiveShotIsWrittenWithItsSettings) {
  ExportRequest live = request(ExportFormat::PngFrames);
  render::Shot shot;
  for (const ExportItem& item : live.items)
    shot.motions.push_back({.clip = item.clip, .colour = item.colour});
  shot.view = render::View::Front;
  live.shot = shot;
  live.shotSettings = {{"colour_by", "speed"}};
  Progress progress;
  exportMotions(live, progress);
  EXPECT_EQ(replacedFiles(live).size(), 10U) << "1 s at 10 fps";
  const std::string recipe =
      render::pngRecipe(readFile(m_folder / "motions_0003.png"), "motions_0003.png");
  EXPECT_NE(recipe.find("colour_by"), std::string::npos) << recipe;
  EXPECT_NE(recipe.find("front"), std::string::npos) << recipe;
  live.fps = 5.0;
  exportMotions(live, progress);
  EXPECT_EQ(replacedFiles(live).size(), 5U) << "the rest of the longer one went";
}

TEST_F(PanelFiles, AnUnreadableFileIsNotTakenWhateverTheTick) {
  ImportFile file{.path = "a.bvh"};
  EXPECT_TRUE(file.taken());
  io::DoctorReport report;
  report.faults.push_back({"unreadable", io::Severity::Error, "why", {}});
  file.reports = {report};
  EXPECT_FALSE(file.taken());
  file.reports = {io::DoctorReport{}};
  EXPECT_TRUE(file.taken()) << "read otherwise, it is readable again";
}

TEST_F(PanelFiles, ATrainingRunIsReadFromItsFolder) {
  writeFileAtomically(m_folder / "log.csv",
                      "step,seconds,learning_rate,train_bits_per_frame,valid_bits_per_frame,"
                      "test_bits_per_frame,gradient_norm,skipped\n"
                      "100,60.0,0.001,-10,-12,nan,5,0\n200,120.0,0.001,-20,-30,-25,5,0\n"
                      "300,180.0,0.001,-22,-28,-25,5,0\n");
  for (const char* name : {"best.marey", "last.marey", "snapshots/step_0000200.marey",
                           "checkpoints/step_0000100.marey", "checkpoints/step_0000200.marey"})
    writeFileAtomically(m_folder / name, "x");
  const TrainingRun run = readTrainingRun(m_folder);
  ASSERT_EQ(run.rows.size(), 3u);
  EXPECT_TRUE(std::isnan(run.rows[0].test));
  ASSERT_EQ(run.checkpoints.size(), 4u) << "a step that is kept twice is one";
  EXPECT_EQ(run.checkpoints[0].name, "step 100");
  EXPECT_EQ(run.checkpoints[1].name, "step 200");
  EXPECT_EQ(run.checkpoints[2].name, "best (step 200)");
  EXPECT_EQ(run.checkpoints[3].name, "last (step 300)");
  const double stages[] = {0.0, 0.5, 0.5, 1.0};
  for (size_t i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(stageOf(run, run.checkpoints[i]), stages[i]);
  writeFileAtomically(m_folder / "log.csv", "step,seconds,\n1,2\n");
  EXPECT_THROW(readTrainingRun(m_folder), InputError);
}

}  // namespace
}  // namespace marey
