#include "experiment/left_out.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "motion/main_body.h"

namespace marey {
namespace {

/// Keeps what `whyNot` has nothing against.
std::vector<LeftOut> keep(std::vector<Clip>& clips,
                          const std::function<std::string(const Clip&)>& whyNot) {
  std::vector<Clip> kept;
  std::vector<LeftOut> out;
  for (Clip& clip : clips) {
    std::string why = whyNot(clip);
    if (why.empty())
      kept.push_back(std::move(clip));
    else
      out.push_back({clip.name, std::move(why)});
  }
  clips = std::move(kept);
  return out;
}

}  // namespace

std::vector<LeftOut> keepMainBody(std::vector<Clip>& clips) {
  std::vector<const Skeleton*> skeletons;
  for (const Clip& clip : clips) skeletons.push_back(clip.skeleton.get());
  const int main = mainBody(skeletons);
  if (main < 0) return {};
  const auto body = clips[static_cast<size_t>(main)].skeleton;
  return keep(clips, [&](const Clip& clip) {
    return sameJoints(*clip.skeleton, *body) ? std::string() : otherJoints(*clip.skeleton, *body);
  });
}

std::vector<LeftOut> dropNamed(std::vector<Clip>& clips, const std::vector<std::string>& names) {
  return keep(clips, [&](const Clip& clip) -> std::string {
    const bool named = std::find(names.begin(), names.end(), clip.name) != names.end();
    return named ? "not used, as the document says" : "";
  });
}

}  // namespace marey
