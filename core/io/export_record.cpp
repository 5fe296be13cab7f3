#include "io/export_record.h"

#include "io/utf8_names.h"

namespace marey::io {

Json sourceJson(const Clip& clip) {
  const ClipSource& s = clip.source;
  return {{"path", s.path},  {"format", s.format},
          {"unit", s.unit},  {"metres_per_unit", s.metresPerUnit},
          {"up", s.up},      {"fps", s.fps},
          {"notes", s.notes}};
}

Json exportRecord(const Clip& clip, const WriteOptions& options, const Json& details) {
  Json out = options.recipe.is_object() ? options.recipe : Json::object();
  out["clip"] = {{"name", clip.name},
                 {"fps", clip.fps},
                 {"frames", clip.frameCount()},
                 {"joints", clip.jointCount()}};
  out["source"] = sourceJson(clip);
  out["export"] = details;
  return out;
}

Json fitJson(const FitResidual& fit) {
  constexpr double kCentimetres = 100.0;
  Json perJoint = Json::object();
  const std::vector<std::string> names = utf8Names(fit.joints);
  for (size_t j = 0; j < names.size(); ++j) perJoint[names[j]] = kCentimetres * fit.rmsM[j];
  return {{"note",
           "the clip has positions only: rotations of a skeleton with constant bones were fitted "
           "to them by least squares"},
          {"fit_residual_cm", perJoint},
          {"fit_residual_max_cm", kCentimetres * fit.largestM()}};
}

std::filesystem::path recipePath(const std::filesystem::path& path) {
  std::filesystem::path out = path;
  out += ".recipe.json";
  return out;
}

}  // namespace marey::io
