#include "gui/workspace/natural_motions.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "motion/main_body.h"

namespace marey::gui {
namespace {

/// Lines of a message about files that could not be read.
constexpr size_t kMostFaults = 8;
/// Natural clips that are shown at first: a thousand over each other would show nothing.
constexpr size_t kShownAtFirst = 3;

QStringList firstLines(const std::vector<std::string>& lines) {
  QStringList out;
  for (size_t i = 0; i < std::min(lines.size(), kMostFaults); ++i)
    out += QString::fromStdString(lines[i]);
  if (lines.size() > kMostFaults)
    out += NaturalMotions::tr("and %1 more").arg(lines.size() - kMostFaults);
  return out;
}

QString faultText(const std::vector<std::string>& faults) {
  QStringList lines = firstLines(faults);
  lines += NaturalMotions::tr("The rest is shown. File ▸ Reload natural motion tries again.");
  return lines.join(u'\n');
}

/// Clips of another skeleton than most: they are shown, but nothing can compare them.
QString oddText(const MotionGroup& natural) {
  std::vector<const Skeleton*> bodies;
  for (const Motion& motion : natural.motions) bodies.push_back(motion.clip->skeleton.get());
  const int main = mainBody(bodies);
  std::vector<std::string> odd;
  for (const Motion& motion : natural.motions)
    if (const Skeleton& body = *motion.clip->skeleton;
        main >= 0 && !sameJoints(body, *bodies[static_cast<size_t>(main)]))
      odd.push_back(motion.clip->name + ": " +
                    otherJoints(body, *bodies[static_cast<size_t>(main)]));
  if (odd.empty()) return {};
  QStringList lines = firstLines(odd);
  lines += NaturalMotions::tr(
               "%1 of %2 natural clips are shown but not counted: their joints are not "
               "those that most clips have.")
               .arg(odd.size())
               .arg(natural.motions.size());
  return lines.join(u'\n');
}

/// A clip of another skeleton than the model's leaves the others alone: its score has no name, and
/// panels count it.
std::vector<ClipScore> scoresOf(const MotionModel& model, const std::vector<ClipPtr>& clips,
                                Progress& progress) {
  std::vector<Clip> fitting;
  std::vector<size_t> places;
  for (size_t i = 0; i < clips.size(); ++i) {
    if (!whyNotScored(model.info(), *clips[i]).empty()) continue;
    fitting.push_back(*clips[i]);
    places.push_back(i);
  }
  std::vector<ClipScore> out(clips.size());
  auto scores = scoreClips(model, fitting, false, progress);
  for (size_t k = 0; k < places.size(); ++k) out[places[k]] = std::move(scores[k]);
  return out;
}

/// Calls `visit` with every motion and its number in its source.
template <typename Motions, typename Visit>
void forEachOfSource(Motions& motions, Visit&& visit) {
  int number = 0;
  for (size_t i = 0; i < motions.size(); ++i) {
    number = i > 0 && motions[i].source == motions[i - 1].source ? number + 1 : 0;
    visit(motions[i], number);
  }
}

}  // namespace

NaturalMotions::NaturalMotions(NaturalParts parts, QObject* parent)
    : QObject(parent), m_parts(std::move(parts)) {
  connect(&m_parts.jobs, &JobQueue::ended, this, [this](int job, bool) {
    std::erase_if(m_scoring, [job](const auto& entry) { return entry.second == job; });
  });
}

void NaturalMotions::read() {
  const int version = ++m_version;
  m_scores.clear();
  const auto scoring = std::exchange(m_scoring, {});
  for (const auto& [model, job] : scoring) m_parts.jobs.cancel(job);
  m_parts.jobs.cancel(m_job);
  const Experiment document = m_parts.document.experiment();
  if (document.natural.empty()) return take({});
  auto natural = std::make_shared<NaturalMotion>();
  m_job = m_parts.jobs.start(
      Lane::Files, tr("Reading natural motion"),
      [natural, document](Progress& progress) { *natural = readableNatural(document, progress); },
      [this, natural, version] {
        if (version == m_version) take(std::move(*natural));
      },
      this);
}

void NaturalMotions::take(NaturalMotion natural) {
  MotionGroup group{.name = "Natural"};
  group.motions.reserve(natural.clips.size());
  for (size_t i = 0; i < natural.clips.size(); ++i)
    group.motions.push_back({.clip = std::make_shared<const Clip>(std::move(natural.clips[i])),
                             .score = {},
                             .visible = false,
                             .source = std::move(natural.sources[i])});
  chooseShown(group);
  const QString odd = oddText(group);
  m_parts.motions.setNatural(std::move(group));
  // They followed the control of clips that are there no more.
  std::vector<int> gone;
  for (const MotionGroup& other : m_parts.motions.groups())
    if (other.heldOut()) gone.push_back(other.id);
  for (const int id : gone) m_parts.motions.remove(id);
  m_inputs = std::move(natural.inputs);
  followUse();
  m_parts.motions.tell();
  Q_EMIT scoresChanged();
  if (!natural.faults.empty())
    Q_EMIT failed(tr("Reading natural motion"), faultText(natural.faults));
  if (!odd.isEmpty()) Q_EMIT failed(tr("Comparing natural motion"), odd);
  io::InputReport all;
  for (const auto& [source, inputs] : m_inputs) all.add(inputs);
  if (const std::string missing = all.missingText(); !missing.empty())
    Q_EMIT noticed(
        tr("Natural motion: %1; the tip of its row in Motions lists them with the reasons")
            .arg(QString::fromStdString(missing)));
}

std::vector<int> NaturalMotions::used() const {
  std::vector<int> out;
  const MotionGroup* group = m_parts.motions.natural();
  for (size_t i = 0; group != nullptr && i < group->motions.size(); ++i)
    if (group->motions[i].used) out.push_back(static_cast<int>(i));
  return out;
}

void NaturalMotions::followUse() {
  const auto& names = m_parts.document.experiment().naturalLeftOut;
  const std::set<std::string> leftOut(names.begin(), names.end());
  for (MotionGroup& group : m_parts.motions.all())
    for (Motion& motion : group.motions)
      if (group.natural()) motion.used = !leftOut.contains(motion.clip->name);
}

const std::vector<ClipScore>* NaturalMotions::scores(const std::string& system) const {
  const Document& document = m_parts.document;
  const int index = document.systemIndex(system);
  if (index < 0 || m_scores.empty()) return nullptr;
  const std::string file =
      document.modelFile(document.experiment().systems[static_cast<size_t>(index)]);
  const auto found = m_scores.find(ModelCache::stampOf(file));
  return found == m_scores.end() ? nullptr : &found->second;
}

void NaturalMotions::score(const std::string& system) {
  const Document& document = m_parts.document;
  const int index = document.systemIndex(system);
  const MotionGroup* natural = m_parts.motions.natural();
  if (index < 0 || natural == nullptr) return;
  const std::string file =
      document.modelFile(document.experiment().systems[static_cast<size_t>(index)]);
  const std::string stamp = ModelCache::stampOf(file);
  if (m_scores.contains(stamp) || m_scoring.contains(stamp)) return;
  std::vector<ClipPtr> clips;
  for (const Motion& motion : natural->motions) clips.push_back(motion.clip);
  auto scores = std::make_shared<std::vector<ClipScore>>();
  m_scoring[stamp] = m_parts.jobs.start(
      Lane::Models, tr("Scoring natural motion under %1").arg(QString::fromStdString(system)),
      [models = m_parts.models, clips, file, scores](Progress& progress) {
        *scores = scoresOf(*models->model(file), clips, progress);
      },
      [this, scores, stamp, version = m_version] {
        if (version != m_version) return;
        m_scores[stamp] = std::move(*scores);
        Q_EMIT scoresChanged();
      },
      this);
}

std::optional<std::vector<ShownClips>> NaturalMotions::shown() const {
  const MotionGroup* group = m_parts.motions.natural();
  if (group == nullptr) return m_shown;
  std::vector<ShownClips> out;
  forEachOfSource(group->motions, [&](const Motion& motion, int number) {
    if (number == 0) out.push_back({motion.source, {}});
    if (motion.visible) out.back().clips.push_back(number);
  });
  return out;
}

void NaturalMotions::renameSources(const std::vector<ShownClips>& shown) {
  const MotionGroup* natural = m_parts.motions.natural();
  if (natural == nullptr) return;
  MotionGroup& group = *m_parts.motions.find(natural->id);
  size_t at = 0;
  std::string before;
  for (size_t i = 0; i < group.motions.size(); ++i) {
    std::string& source = group.motions[i].source;
    if (i > 0 && source != before) ++at;
    before = std::exchange(source, shown[at].source);
  }
}

/// Clips of a source that was there keep their ticks; of new ones the first few are shown.
void NaturalMotions::chooseShown(MotionGroup& group) {
  const std::vector<ShownClips> before =
      m_shown ? *m_shown : shown().value_or(std::vector<ShownClips>{});
  m_shown.reset();
  std::vector<Motion*> fresh;
  size_t count = 0;
  forEachOfSource(group.motions, [&](Motion& motion, int number) {
    const auto known = std::find_if(before.begin(), before.end(), [&](const ShownClips& source) {
      return source.source == motion.source;
    });
    if (known == before.end()) {
      fresh.push_back(&motion);
      return;
    }
    motion.visible =
        std::find(known->clips.begin(), known->clips.end(), number) != known->clips.end();
    count += motion.visible ? 1 : 0;
  });
  for (Motion* motion : fresh) motion->visible = count++ < kShownAtFirst;
}

}  // namespace marey::gui
