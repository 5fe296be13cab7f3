// Weights that were read once, for all threads that draw or score with them.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "model/model_family.h"

namespace marey {

/// Thread-safe.
class ModelCache {
 public:
  /// The families must outlive the cache.
  explicit ModelCache(std::span<const ModelFamily> families) : m_families(families) {}
  /// The model of a file as it is now. Throws FileError or InputError.
  std::shared_ptr<const MotionModel> model(const std::string& file);
  /// Those that it holds now.
  std::vector<std::shared_ptr<const MotionModel>> held();
  /// What a sampling of a file's model takes, read once without its weights. Throws as `model`.
  std::vector<SamplingOption> optionSchema(const std::string& file);
  /// Differs for other files, and for a file that was written anew.
  static std::string stampOf(const std::string& file);

 private:
  struct Entry {
    std::string stamp;
    std::shared_ptr<const MotionModel> model;
  };
  std::span<const ModelFamily> m_families;
  std::mutex m_mutex;
  std::vector<Entry> m_entries;                                  ///< the one used last in front
  std::map<std::string, std::vector<SamplingOption>> m_schemas;  ///< by stamp
};

/// Throws InputError unless a model has the document's frame rate.
void requireRate(const MotionModel& model, const std::string& file, double fps);

}  // namespace marey
