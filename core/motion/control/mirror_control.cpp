// Control of a body that is mirrored, or goes backwards in time.
#include <algorithm>

#include "motion/control/encode_control.h"
#include "motion/joint_names.h"
#include "motion/roles.h"

namespace marey {
namespace {

/// Columns change places with those of the other side's name.
void swapSides(const std::vector<std::string>& names, long first, const Matrix& from, Matrix& to) {
  std::vector<std::string> words;  // a name may be a side alone: 'left'
  for (const std::string& name : names) words.push_back("value " + name);
  const auto sides = readJointNames(words);
  for (size_t i = 0; i < names.size(); ++i)
    to.col(first + static_cast<long>(i)) = from.col(first + sides[i].mirror);
}

void mirrorBody(const ControlColumns& at, const Skeleton& skeleton, const Matrix& from,
                Matrix& to) {
  const auto mirror = rolesOf(skeleton).mirror;
  for (int j = 0; j < at.channel->joints; ++j)
    for (int k = 0; k < 3; ++k)
      to.col(at.first + 3 * j + k) =
          (k == 0 ? -1.F : 1.F) * from.col(at.first + 3 * mirror[static_cast<size_t>(j)] + k);
}

}  // namespace

Matrix mirroredControl(const ControlLayout& layout, double fps, const Matrix& control,
                       const Skeleton& skeleton) {
  Matrix out = control;
  for (const ControlColumns& at : columnsOf(layout, fps)) {
    const auto names = static_cast<long>(at.channel->values.size());
    switch (at.channel->kind) {
      case ControlKind::RootMotion:
        out.col(at.first) *= -1.F;
        out.col(at.first + 2) *= -1.F;
        break;
      case ControlKind::FuturePath:
        for (int i = 0; i < at.width; i += 2) out.col(at.first + i) *= -1.F;
        break;
      case ControlKind::Label:
        swapSides(at.channel->values, at.first, control, out);
        break;
      case ControlKind::Array:
        for (long first = at.first; first < at.first + at.width; first += names)
          swapSides(at.channel->values, first, control, out);
        break;
      case ControlKind::Skeleton:
        mirrorBody(at, skeleton, control, out);
        break;
    }
  }
  return out;
}

Matrix reversedControl(const ControlLayout& layout, double fps, const Matrix& control,
                       const std::vector<RootFrame>& trajectory) {
  Matrix out = control.colwise().reverse();
  ControlLayout ways;  // what follows from the trajectory alone
  for (const ControlChannel& channel : layout)
    if (channel.kind == ControlKind::RootMotion || channel.kind == ControlKind::FuturePath)
      ways.push_back(channel);
  const Matrix along = encodeControl(ways, trajectory, {}, fps, {.path = "reversed"});
  const auto from = columnsOf(ways, fps);
  size_t way = 0;
  for (const ControlColumns& at : columnsOf(layout, fps)) {
    const ControlChannel& channel = *at.channel;
    if (channel.kind == ControlKind::RootMotion || channel.kind == ControlKind::FuturePath) {
      out.middleCols(at.first, at.width) = along.middleCols(from[way].first, at.width);
      ++way;
    }
    if (channel.kind != ControlKind::Array) continue;
    // What was ahead is past: the rows are made anew of the frames' own values.
    const auto width = static_cast<long>(channel.values.size());
    const long past = pastFrames(channel, fps), last = out.rows() - 1;
    const Matrix own = out.middleCols(at.first + past * width, width);
    for (long k = 0; k < at.width / width; ++k)
      for (long t = 0; t <= last; ++t)
        out.row(t).segment(at.first + k * width, width) =
            own.row(std::clamp(t + k - past, 0L, last));
  }
  return out;
}

}  // namespace marey
