#include "render/scene/live_scene.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <vtkCallbackCommand.h>
#include <vtkCullerCollection.h>

#include "base/error.h"
#include "render/scene/live_internals.h"

namespace marey::render {

namespace {
void checkMotion(const LiveMotion& motion, const Track& track) {
  const auto frames = static_cast<size_t>(track.clip().frameCount());
  if (motion.frameColours.empty() || motion.frameColours.size() == frames) return;
  throwInput({.path = "motion '" + motion.label + "'"}, fmt::format("{} frame colours", frames),
             "{}", motion.frameColours.size());
}

/// Tracks of clips that were there before are kept: what was worked out from them is not lost.
std::vector<std::shared_ptr<Track>> tracksFor(const std::vector<LiveMotion>& motions,
                                              std::span<const std::shared_ptr<Track>> before) {
  std::multimap<const Clip*, std::shared_ptr<Track>> known;
  for (const auto& track : before) known.emplace(&track->clip(), track);
  std::vector<std::shared_ptr<Track>> tracks;
  for (const LiveMotion& motion : motions) {
    const auto found = known.find(motion.clip.get());
    if (found == known.end()) {
      tracks.push_back(std::make_shared<Track>(motion.clip));
    } else {
      tracks.push_back(found->second);
      known.erase(found);
    }
    checkMotion(motion, *tracks.back());
  }
  return tracks;
}
}  // namespace

LiveScene::Internals::Internals() {
  renderer->GetCullers()->RemoveAllItems();
  renderer->AutomaticLightCreationOff();
  renderer->SetActiveCamera(eye);
  auto command = vtkSmartPointer<vtkCallbackCommand>::New();
  command->SetCallback([](vtkObject*, unsigned long, void* internals, void*) {
    static_cast<Internals*>(internals)->draw();
  });
  command->SetClientData(this);
  m_observer = renderer->AddObserver(vtkCommand::StartEvent, command);
}

LiveScene::Internals::~Internals() {
  renderer->RemoveObserver(m_observer);
}

std::span<const Vec3> LiveScene::Internals::poseOf(size_t motion) {
  updatePoses();
  return {poses.data() + offsets[motion], static_cast<size_t>(tracks[motion]->jointCount())};
}

void LiveScene::Internals::updatePoses() {
  if (posesCurrent) return;
  offsets.resize(tracks.size());
  size_t joints = 0;
  for (size_t m = 0; m < tracks.size(); ++m) {
    offsets[m] = joints;
    joints += static_cast<size_t>(tracks[m]->jointCount());
  }
  poses.resize(joints);
  for (size_t m = 0; m < tracks.size(); ++m) {
    tracks[m]->pose(time, options.placement,
                    {poses.data() + offsets[m], static_cast<size_t>(tracks[m]->jointCount())});
  }
  posesCurrent = true;
}

double LiveScene::Internals::longestS() const {
  double longest = 0.0;
  for (const auto& track : tracks) longest = std::max(longest, track->lastS());
  return longest;
}

LiveScene::LiveScene() : m_internals(std::make_unique<Internals>()) {
  setOptions({});
  setView(LiveView::ThreeQuarter, 1280, 720);
}
LiveScene::~LiveScene() = default;
LiveScene::LiveScene(LiveScene&&) noexcept = default;
LiveScene& LiveScene::operator=(LiveScene&&) noexcept = default;

vtkRenderer* LiveScene::renderer() const {
  return m_internals->renderer;
}

void LiveScene::setMotions(std::vector<LiveMotion> motions) {
  Internals& i = *m_internals;
  auto tracks = tracksFor(motions, i.tracks);
  if (i.options.placement == Placement::RootAligned)
    for (const auto& track : tracks) track->needRoots();
  i.tracks = std::move(tracks);
  i.motions = std::move(motions);
  i.someHighlighted = std::any_of(i.motions.begin(), i.motions.end(),
                                  [](const LiveMotion& m) { return m.highlighted; });
  if (i.options.placement == Placement::SideBySide) placeSideBySide(i.tracks);
  i.sceneChanged = true;
  i.posesCurrent = false;
  i.updateExtent();
  i.followed = i.meanRoot(i.time);
}

const std::vector<LiveMotion>& LiveScene::motions() const {
  return m_internals->motions;
}

void LiveScene::setOptions(LiveOptions options) {
  Internals& i = *m_internals;
  if (options.placement == Placement::RootAligned)
    for (const auto& track : i.tracks) track->needRoots();
  i.options = std::move(options);
  if (i.options.placement == Placement::SideBySide) placeSideBySide(i.tracks);
  i.sceneChanged = true;
  i.posesCurrent = false;
  i.updateExtent();
  i.followed = i.meanRoot(i.time);
  const Colour back = background();
  i.renderer->SetBackground(back.r, back.g, back.b);
  i.floor.setVisible(i.options.floor);
  i.floor.setLook(backdropOf(i.options.dark), std::max(0.01, i.options.gridM));
}

const LiveOptions& LiveScene::options() const {
  return m_internals->options;
}

void LiveScene::setTime(double seconds) {
  Internals& i = *m_internals;
  if (i.time == seconds) return;
  i.time = seconds;
  i.timeChanged = true;
  i.posesCurrent = false;
  if (i.following) i.followNow();
}

double LiveScene::time() const {
  return m_internals->time;
}

double LiveScene::seconds() const {
  return m_internals->longestS();
}

std::vector<Vec3> LiveScene::pose(size_t motion) const {
  const auto pose = m_internals->poseOf(motion);
  return {pose.begin(), pose.end()};
}

Colour LiveScene::background() const {
  return backdropOf(m_internals->options.dark).background;
}

const LiveCost& LiveScene::cost() const {
  return m_internals->cost;
}

}  // namespace marey::render
