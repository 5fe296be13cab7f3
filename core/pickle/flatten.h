// Turns the object of a PyTorch checkpoint into paths. Private to its reader.
#pragma once

#include <map>
#include <set>
#include <string>

#include "pickle/torch_checkpoint.h"
#include "pickle/views.h"

namespace marey::pickle {

/// Walks an object and fills a checkpoint. Shared parts are visited wherever they appear, so the
/// number of visits and the length of the text they make are bounded.
class Flattener {
 public:
  Flattener(TensorReader& reader, const TorchTensorFilter& filter, std::string origin);

  /// Throws InputError. Call once.
  TorchCheckpoint flatten(const Value& root);

 private:
  void visit(const Value& value, const std::string& path, int depth);
  void visitDict(const Value& dict, const std::string& path, int depth);
  void visitList(const Value& list, const std::string& path, int depth);
  void addTensor(const View& view, const std::string& path);
  Json scalar(const Value& value, const std::string& path);
  std::string child(const std::string& path, const std::string& key);
  std::string keyText(const Value& key, const std::string& path);
  void chargeVisits(size_t count, const std::string& path);
  void chargeText(size_t bytes, const std::string& path);
  Place place(const std::string& path) const;

  TensorReader& m_reader;
  const TorchTensorFilter& m_filter;
  std::string m_origin;
  std::map<std::string, Tensor> m_tensors;
  std::map<std::string, Json> m_scalars;
  std::map<std::string, std::string> m_opaque;
  std::vector<std::string> m_skipped;
  std::set<std::string> m_seen;  ///< paths of all leaves, of skipped tensors too
  size_t m_visits = 0;
  size_t m_textBytes = 0;
};

}  // namespace marey::pickle
