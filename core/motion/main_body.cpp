#include "motion/main_body.h"

#include <fmt/format.h>

namespace marey {

bool sameJoints(const Skeleton& a, const Skeleton& b) {
  return &a == &b || (a.names == b.names && a.parents == b.parents);
}

int mainBody(std::span<const Skeleton* const> skeletons) {
  struct Body {
    int first = 0, count = 0;
  };
  std::vector<Body> bodies;  // few, however many clips there are
  for (size_t i = 0; i < skeletons.size(); ++i) {
    size_t b = 0;
    while (b < bodies.size() &&
           !sameJoints(*skeletons[static_cast<size_t>(bodies[b].first)], *skeletons[i]))
      ++b;
    if (b == bodies.size()) bodies.push_back({static_cast<int>(i), 0});
    ++bodies[b].count;
  }
  Body most{-1, 0};
  for (const Body& body : bodies)
    if (body.count > most.count) most = body;
  return most.first;
}

std::string otherJoints(const Skeleton& skeleton, const Skeleton& wanted) {
  if (skeleton.jointCount() != wanted.jointCount())
    return fmt::format("another skeleton ({} joints, {} wanted)", skeleton.jointCount(),
                       wanted.jointCount());
  for (size_t j = 0; j < skeleton.names.size(); ++j) {
    if (skeleton.names[j] != wanted.names[j])
      return fmt::format("another skeleton (joint {} is '{}', '{}' is wanted)", j,
                         skeleton.names[j], wanted.names[j]);
    if (skeleton.parents[j] != wanted.parents[j])
      return fmt::format("another skeleton (joint '{}' has another parent)", skeleton.names[j]);
  }
  return {};
}

}  // namespace marey
