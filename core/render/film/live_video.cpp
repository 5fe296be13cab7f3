#include "render/film/live_video.h"

#include <algorithm>
#include <cmath>

#include "render/scene/live_picture.h"

namespace marey::render {
namespace {

LiveScene sceneOf(const LiveShot& shot, int width, int height) {
  LiveScene scene;
  scene.setMotions(shot.motions);
  scene.setOptions(shot.options);
  if (shot.view) {
    scene.setTime(shot.beginS);
    scene.setOrthographic(shot.orthographic);
    scene.setFollow(shot.follow);
    scene.setView(*shot.view, width, height);
  } else {
    // A following camera is tied to the figures where they are at the viewpoint's time.
    scene.setViewpoint(shot.viewpoint);
    scene.setFollow(shot.follow);
  }
  return scene;
}

Image taken(LivePicture& picture, const LiveScene& scene, const Image& over, int width,
            int height) {
  Image out = picture.take(scene, width, height);
  if (!over.pixels.empty()) layOver(out, over);
  return out;
}

const char* nameOf(LiveView view) {
  switch (view) {
    case LiveView::ThreeQuarter:
      return "three-quarter";
    case LiveView::Side:
      return "side";
    case LiveView::Front:
      return "front";
    case LiveView::Back:
      return "back";
    case LiveView::Top:
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

Json cameraJson(const LiveShot& shot) {
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

int frameCountOf(const LiveShot& shot, double fps) {
  double lastsS = 0.0;
  for (const LiveMotion& motion : shot.motions)
    if (motion.clip) lastsS = std::max(lastsS, motion.clip->seconds());
  const auto framesIn = [fps](double seconds) {
    return static_cast<int>(std::floor(seconds * fps + 1e-6));
  };
  int frames = framesIn(lastsS - shot.beginS);
  if (shot.endS) frames = std::min(frames, framesIn(*shot.endS - shot.beginS) + 1);
  return std::max(1, frames);
}

Image drawLive(const LiveShot& shot, double timeS, int width, int height) {
  LiveScene scene = sceneOf(shot, width, height);
  scene.setTime(timeS);
  LivePicture picture;
  return taken(picture, scene, shot.over, width, height);
}

int writeLiveVideo(const std::filesystem::path& path, const LiveShot& shot,
                   const VideoFormat& format, const Recipe& recipe, Progress& progress) {
  VideoWriter writer(path, format, recipe);
  const int frames = frameCountOf(shot, format.fps);
  LiveScene scene = sceneOf(shot, format.width, format.height);
  LivePicture picture;
  for (int k = 0; k < frames; ++k) {
    progress.throwIfCancelled();
    scene.setTime(shot.beginS + k / format.fps);
    writer.add(taken(picture, scene, shot.over, format.width, format.height));
    progress.report((k + 1.0) / frames, fmt::format("frame {} of {}", k + 1, frames));
  }
  writer.finish();
  return frames;
}

Json toJson(const LiveShot& shot) {
  const LiveOptions& o = shot.options;
  Json out = {{"camera", cameraJson(shot)},
              {"follow", shot.follow},
              {"placement", nameOf(o.placement)},
              {"detail", nameOf(o.detail)},
              {"ghosts_s", o.ghostsS},
              {"contact_marks", o.contactMarks},
              {"floor", o.floor},
              {"shadow", o.floor && o.shadow},
              {"path", !o.path.empty()},
              {"dark", o.dark},
              {"begin_s", shot.beginS}};
  if (o.contactMarks) out["contact_tolerance_cm_s"] = o.contacts.toleranceCmS;
  if (shot.endS) out["end_s"] = *shot.endS;
  if (shot.motions.empty()) return out;
  // Joints by name: bodies may differ, but all show the same ones.
  const LiveMotion& first = shot.motions.front();
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
