#include "render/scene/shot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/error.h"
#include "render/scene/caption.h"
#include "render/scene/scene_picture.h"

namespace marey::render {
namespace {

Scene sceneOf(const Shot& shot, const Frame& frame) {
  Scene scene;
  scene.setMotions(shot.motions);
  scene.setOptions(shot.options);
  if (shot.view) {
    scene.setTime(shot.beginS);
    scene.setOrthographic(shot.orthographic);
    scene.setFollow(shot.follow);
    scene.setView(*shot.view, frame);
  } else {
    // A following camera is tied to the figures where they are at the viewpoint's time.
    scene.setViewpoint(shot.viewpoint);
    scene.setFollow(shot.follow);
  }
  return scene;
}

void check(const Shot& shot, int width, int height) {
  const Place place{.path = "picture '" + shot.caption.title + "'"};
  if (shot.motions.empty()) throw InputError(place, "at least one motion", "none");
  if (shot.fineness < 1) throwInput(place, "a fineness of 1 or more", "{}", shot.fineness);
  if (width < 32 || height < 32) throwInput(place, "32x32 pixels or more", "{}x{}", width, height);
}

void checkStrobe(const Shot& shot, double everyS) {
  if (!(everyS > 0.0))
    throwInput({.path = "picture '" + shot.caption.title + "'"}, "a strobe interval above zero",
               "{} s", everyS);
}

/// The average of each `by` x `by` pixels.
Image shrunk(const Image& large, int by) {
  if (by == 1) return large;
  Image image(large.width / by, large.height / by);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 4; ++c) {
        int sum = 0;
        for (int dy = 0; dy < by; ++dy)
          for (int dx = 0; dx < by; ++dx) sum += large.at(by * x + dx, by * y + dy)[c];
        image.at(x, y)[c] = static_cast<uint8_t>((sum + by * by / 2) / (by * by));
      }
  return image;
}

/// The free part of a picture; title, legend and scale bar need some of it.
Frame frameOf(const Shot& shot, int width, int height) {
  const double margin = 0.05 * std::min(width, height) + 6.0;
  return {.width = width,
          .height = height,
          .left = margin,
          .right = margin,
          .top = margin + captionHeight(shot, height),
          .bottom = margin + (shot.caption.scaleBar ? 0.02 * height + 6.0 : 0.0)};
}

const char* nameOf(View view) {
  switch (view) {
    case View::ThreeQuarter:
      return "three-quarter";
    case View::Side:
      return "side";
    case View::Front:
      return "front";
    case View::Back:
      return "back";
    case View::Top:
      break;
  }
  return "top";
}

const char* nameOf(Placement placement) {
  if (placement == Placement::RootAligned) return "root-aligned";
  return placement == Placement::SideBySide ? "side by side" : "world";
}

const char* nameOf(BodyDetail detail) {
  if (detail == BodyDetail::Capsules) return "capsules";
  return detail == BodyDetail::Lines ? "lines" : "auto";
}

Json cameraJson(const Shot& shot) {
  if (shot.view) return {{"view", nameOf(*shot.view)}, {"orthographic", shot.orthographic}};
  const Camera& c = shot.viewpoint.camera;
  const auto place = [](const Vec3& v) { return Json{v.x(), v.y(), v.z()}; };
  Json out = {{"eye", place(c.eye)},
              {"target", place(c.target)},
              {"up", place(c.up)},
              {"orthographic", c.orthographic},
              {"at_s", shot.viewpoint.timeS}};
  if (c.orthographic)
    out["height_m"] = c.heightM;
  else
    out["fov_y_rad"] = c.fovY;
  return out;
}

}  // namespace

double sampleOpacity(size_t samples, bool besideNatural) {
  const auto count = static_cast<double>(std::max<size_t>(1, samples));
  return besideNatural ? std::clamp(1.4 / count, 0.2, 0.6) : std::clamp(3.0 / count, 0.25, 1.0);
}

Shot printed(std::vector<SceneMotion> motions) {
  constexpr size_t mostNames = 6;
  std::set<std::string> names;
  for (const SceneMotion& motion : motions) names.insert(motion.label);
  Shot shot{.motions = std::move(motions), .options = {}, .view = View::ThreeQuarter};
  shot.options.tone = Tone::Paper;
  shot.options.contactMarks = true;
  shot.options.solidFirst = true;
  shot.fineness = 2;
  shot.caption = {.title = {}, .legend = names.size() <= mostNames, .scaleBar = true};
  return shot;
}

Shot shotOfMotions(std::vector<SceneMotion> motions) {
  const auto isNatural = [](const SceneMotion& m) { return m.colour == naturalColour(); };
  const auto natural =
      static_cast<size_t>(std::count_if(motions.begin(), motions.end(), isNatural));
  const double opacity = sampleOpacity(motions.size() - natural, natural > 0);
  for (SceneMotion& motion : motions) motion.opacity = isNatural(motion) ? 1.0 : opacity;
  return printed(std::move(motions));
}

Shot strobed(Shot shot, double everyS) {
  checkStrobe(shot, everyS);
  shot.options.strobe = {.everyS = everyS, .opacity = 1.0, .untilNow = false, .shadows = true};
  shot.options.present = false;
  return shot;
}

Shot withTrail(Shot shot, double everyS) {
  checkStrobe(shot, everyS);
  shot.options.strobe = {.everyS = everyS, .opacity = 0.3, .untilNow = true, .shadows = true};
  return shot;
}

struct ShotPicture::Internals {
  Shot shot;
  int width, height;
  Scene scene;
  std::optional<ScaleBar> bar;  ///< where it lies while the camera is at `barEye`
  Vec3 barEye = Vec3::Zero();
  ScenePicture picture;

  void placeBar();
};

void ShotPicture::Internals::placeBar() {
  // It lies in front of the figures as seen from this direction, so it needs a camera first.
  bar = scaleBarFor(scene.camera(), scene.outline());
  if (shot.view) scene.fit(frameOf(shot, width, height), std::array{bar->from, bar->to});
  barEye = scene.camera().eye;
}

ShotPicture::ShotPicture(Shot shot, int width, int height) {
  check(shot, width, height);
  Scene scene = sceneOf(shot, frameOf(shot, width, height));
  m_internals = std::make_unique<Internals>(
      Internals{std::move(shot), width, height, std::move(scene), {}, Vec3::Zero(), {}});
  if (m_internals->shot.caption.scaleBar) m_internals->placeBar();
}

ShotPicture::~ShotPicture() = default;
ShotPicture::ShotPicture(ShotPicture&&) noexcept = default;
ShotPicture& ShotPicture::operator=(ShotPicture&&) noexcept = default;

Image ShotPicture::at(double timeS) {
  Internals& i = *m_internals;
  i.scene.setTime(timeS);
  const int fine = i.shot.fineness;
  Image out = shrunk(i.picture.take(i.scene, fine * i.width, fine * i.height), fine);
  if (!i.shot.over.pixels.empty()) layOver(out, i.shot.over);
  const Camera camera = i.scene.camera();
  std::optional<ScaleBar> bar = i.bar;
  if (bar) {
    // A camera that follows takes it along.
    const Vec3 shift = camera.eye - i.barEye;
    bar = ScaleBar{bar->from + shift, bar->to + shift};
  }
  if (!bar && captionHeight(i.shot, i.height) == 0.0) return out;
  return withCaption(out, i.shot, camera, bar);
}

Image drawShot(const Shot& shot, double timeS, int width, int height) {
  return ShotPicture(shot, width, height).at(timeS);
}

Image drawEnd(const Shot& shot, int width, int height) {
  double lastS = 0.0;
  for (const SceneMotion& motion : shot.motions)
    if (motion.clip) lastS = std::max(lastS, (motion.clip->frameCount() - 1) / motion.clip->fps);
  return drawShot(shot, lastS, width, height);
}

Json toJson(const Shot& shot) {
  const SceneOptions& o = shot.options;
  Json out = {{"camera", cameraJson(shot)},
              {"follow", shot.follow},
              {"placement", nameOf(o.placement)},
              {"detail", nameOf(o.detail)},
              {"ghosts_s", o.strobe.everyS},
              {"contact_marks", o.contactMarks},
              {"floor", o.floor},
              {"shadow", o.floor && o.shadow},
              {"path", !o.path.empty()},
              {"dark", o.tone == Tone::Dark},
              {"begin_s", shot.beginS}};
  if (o.contactMarks) out["contact_tolerance_cm_s"] = o.contacts.toleranceCmS;
  if (shot.endS) out["end_s"] = *shot.endS;
  if (shot.motions.empty()) return out;
  // Joints by name: bodies may differ, but all show the same ones.
  const SceneMotion& first = shot.motions.front();
  const auto& names = first.clip->skeleton->names;
  Json trails = Json::array();
  for (const int joint : first.trailJoints) trails.push_back(names.at(static_cast<size_t>(joint)));
  if (!trails.empty()) {
    out["trail_joints"] = trails;
    out["trail_s"] = o.trailS;
  }
  if (first.highlightJoint)
    out["highlight_joint"] = names.at(static_cast<size_t>(*first.highlightJoint));
  out["opacity"] = first.opacity;
  return out;
}

}  // namespace marey::render
