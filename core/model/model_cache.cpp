#include "model/model_cache.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"

namespace marey {
namespace {
namespace fs = std::filesystem;

/// A large model takes hundreds of megabytes; a strip of checkpoints names dozens.
constexpr size_t kMostModels = 6;
}  // namespace

std::string ModelCache::stampOf(const std::string& file) {
  std::error_code none;
  const auto written = fs::last_write_time(file, none);
  return file + '\n' + std::to_string(written.time_since_epoch().count());
}

std::shared_ptr<const MotionModel> ModelCache::model(const std::string& file) {
  const std::string stamp = stampOf(file);
  const std::lock_guard lock(m_mutex);
  const auto found = std::find_if(m_entries.begin(), m_entries.end(),
                                  [&](const Entry& entry) { return entry.stamp == stamp; });
  if (found != m_entries.end()) {
    std::rotate(m_entries.begin(), found, found + 1);
    return m_entries.front().model;
  }
  m_entries.insert(m_entries.begin(), {stamp, loadModel(file, m_families)});
  if (m_entries.size() > kMostModels) m_entries.pop_back();
  return m_entries.front().model;
}

std::vector<std::shared_ptr<const MotionModel>> ModelCache::held() {
  const std::lock_guard lock(m_mutex);
  std::vector<std::shared_ptr<const MotionModel>> out;
  for (const Entry& entry : m_entries) out.push_back(entry.model);
  return out;
}

std::vector<SamplingOption> ModelCache::optionSchema(const std::string& file) {
  const std::string stamp = stampOf(file);
  const std::lock_guard lock(m_mutex);
  if (const auto found = m_schemas.find(stamp); found != m_schemas.end()) return found->second;
  return m_schemas[stamp] = optionSchemaOf(file, m_families);
}

void requireRate(const MotionModel& model, const std::string& file, double fps) {
  if (std::abs(model.info().features.fps - fps) > 1e-6)
    throwInput({.path = file}, fmt::format("a model at the document's {} fps", fps), "{}",
               model.info().features.fps);
}

}  // namespace marey
