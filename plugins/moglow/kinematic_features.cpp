#include "moglow/kinematic_features.h"

#include <algorithm>

namespace marey::moglow {
namespace {

using torch::indexing::Slice;

/// Keeps the direction of a movement and squeezes its size.
torch::Tensor squeezed(const torch::Tensor& movement, const torch::Tensor& scale) {
  const auto size = movement.norm(2, -1, true).clamp_min(1e-6);
  return movement * (torch::asinh(size / scale) / size);
}

torch::Tensor footSpeeds(const KinematicBody& body, const Past& past) {
  std::vector<torch::Tensor> parts;
  for (int64_t k = 0; k + 1 < body.order(); ++k)
    for (const int64_t j : body.contacts()) {
      const auto d = (past.poses.select(1, k) - past.poses.select(1, k + 1))
                         .select(1, j)
                         .index({Slice(), Slice(0, 3, 2)});
      const auto r = d.norm(2, -1, true).clamp_min(1e-6);
      parts.push_back(d * (torch::asinh(r / 0.2) + r / 2.0) / r);
    }
  return torch::cat(parts, -1);
}

}  // namespace

torch::Tensor regressors(const KinematicBody& body, const Past& past) {
  std::vector<torch::Tensor> parts{past.poses.select(1, 0).flatten(1)};
  for (int64_t k = 0; k + 1 < body.order(); ++k)
    parts.push_back((past.poses.select(1, k) - past.poses.select(1, k + 1)).flatten(1));
  parts.push_back(past.control);
  return torch::cat(parts, -1);
}

torch::Tensor richRegressors(const KinematicBody& body, const Past& past) {
  return torch::cat({regressors(body, past), footSpeeds(body, past)}, -1);
}

torch::Tensor footFeatures(const KinematicBody& body, const Past& past, size_t foot,
                           const torch::Tensor& slow) {
  const auto& p = past.poses;
  const auto side = torch::tensor({body.side(foot), 1.f}).to(p.options());
  const auto floor = [](const torch::Tensor& v) { return v.index({Slice(), Slice(0, 3, 2)}); };
  const auto movement = [&](int64_t k, int64_t j) {
    return (p.select(1, k) - p.select(1, k + 1)).select(1, j);
  };
  const auto now = p.select(1, 0), control = past.control;
  const int64_t ankle = body.feet()[foot], toe = body.toes()[foot],
                other = body.feet()[std::min(foot ^ 1U, body.feet().size() - 1)];
  return torch::cat({squeezed(floor(movement(0, ankle)) * side, slow),
                     squeezed(floor(movement(1, ankle)) * side, slow),
                     squeezed(movement(0, ankle).narrow(1, 1, 1), slow) * 0.7,
                     now.select(1, ankle).narrow(1, 1, 1) * 0.4,
                     squeezed(floor(movement(0, toe)) * side, slow) * 0.7,
                     now.select(1, toe).narrow(1, 1, 1) * 0.25,
                     floor(now.select(1, ankle) - now.select(1, 0)) * side * 0.08,
                     squeezed(floor(movement(0, 0)) * side, slow) * 0.5,
                     // The other foot says when this one may leave, the control whether it has to.
                     squeezed(floor(movement(0, other)) * side, slow) * 0.5,
                     now.select(1, other).narrow(1, 1, 1) * 0.15,
                     squeezed(control.narrow(1, 0, 2) * side, slow) * 0.5,
                     torch::asinh(control.narrow(1, 2, 1) * body.side(foot) / 0.02) * 0.3},
                    -1);
}

torch::Tensor footScales(const KinematicBody& body, const Past& past) {
  const auto track = past.poses.index_select(2, jointIndex(body.feet(), past.poses))
                         .index({Slice(), Slice(), Slice(), Slice(0, 3, 2)});
  const auto one = (track.select(1, 0) - track.select(1, 1)).norm(2, -1);
  const auto two = (track.select(1, 0) - track.select(1, 2)).norm(2, -1) / 2.0;
  const auto speed = torch::minimum(one, two);
  return torch::minimum(0.06 + 0.45 * speed, 0.9 + 0.02 * speed);
}

torch::Tensor regimeFeatures(const KinematicBody& body, const Past& past) {
  const auto now = past.poses.select(1, 0), movement = now - past.poses.select(1, 1);
  std::vector<torch::Tensor> parts;
  for (const int64_t j : body.contacts())
    parts.push_back(squeezed(movement.select(1, j), torch::full({}, 0.5, movement.options())));
  for (const int64_t j : body.contacts()) parts.push_back(now.select(1, j).narrow(1, 1, 1) * 0.3);
  for (const int64_t j : body.feet())
    parts.push_back(now.select(1, j).index({Slice(), Slice(0, 3, 2)}) * 0.05);
  parts.push_back(torch::asinh(past.control.narrow(1, 0, 2) / 0.5) * 0.7);
  parts.push_back(torch::asinh(past.control.narrow(1, 2, 1) / 0.02) * 0.5);
  parts.push_back(torch::asinh(movement.norm(2, -1).mean(1, true) / 0.3));
  return torch::cat(parts, -1);
}

int64_t regimeFeatureCount(const KinematicBody& body) {
  const auto contacts = static_cast<int64_t>(body.contacts().size()),
             feet = static_cast<int64_t>(body.feet().size());
  return 3 * contacts + contacts + 2 * feet + 4;
}

}  // namespace marey::moglow
