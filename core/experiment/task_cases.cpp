#include "experiment/task_cases.h"

#include "base/packing.h"
#include "model/clip_length.h"

namespace marey {
namespace {

void pack(const PoseError& error, Packer& packer) {
  packer.add(error.meanCm).add(error.bestCm).add(error.byFrameCm);
}

PoseError unpackError(Unpacker& bytes) {
  PoseError out{
      .meanCm = bytes.number<double>(), .bestCm = bytes.number<double>(), .byFrameCm = {}};
  out.byFrameCm = bytes.list<double>();
  return out;
}

/// Packed errors with and without the model; nothing of a clip that is too short.
std::string judged(const MotionModel& model, const Task& task, const TaskRequest& request,
                   Progress& progress) {
  Packer packer;
  try {
    const TaskOutcome outcome = runTask(task, model, request, progress);
    if (!outcome.reference || !outcome.without)
      throw InputError({.path = task.name}, "options with which the truth is known", "others");
    pack(poseError(outcome.motions, *outcome.reference), packer);
    pack(poseError({&*outcome.without, 1}, *outcome.reference), packer);
  } catch (const ShortClipError&) {
    return {};
  }
  return packer.take();
}

}  // namespace

CaseResult runCase(const MotionModel& model, const ExperimentCase& c,
                   const std::vector<Clip>& natural, uint64_t seed, const ExperimentSystem& system,
                   Progress& progress, Ranks& ranks) {
  const Task& task = taskNamed(c.task);
  CaseResult out{.whyNot = task.whyNot(model)};
  if (!out.whyNot.empty()) return out;
  const auto share = [&](size_t begin, size_t end, Progress& own) {
    std::vector<std::string> packed;
    TaskRequest request = requestOf(c, seed, system);
    for (size_t i = begin; i < end; ++i) {
      request.clip = natural[i];
      Progress part =
          own.part(static_cast<double>(i - begin) / static_cast<double>(end - begin),
                   static_cast<double>(i + 1 - begin) / static_cast<double>(end - begin));
      packed.push_back(judged(model, task, request, part));
    }
    return packed;
  };
  for (const std::string& packed : ranks.gather(natural.size(), share, progress)) {
    if (packed.empty()) {
      ++out.leftOut;
      continue;
    }
    Unpacker bytes(packed);
    out.errors.push_back(unpackError(bytes));
    out.without.push_back(unpackError(bytes));
  }
  return out;
}

}  // namespace marey
