// What became of the files that a command or a document was given: which were not read, and what is
// doubtful in those that were.
#pragma once

#include "base/packing.h"
#include "io/doctor.h"
#include "io/inputs.h"

namespace marey::io {

/// A fault that the numbers hang on (see doubtsOf), of one clip.
struct Doubt {
  std::string path, clip, kind, text;
};

/// A clip that was read and cannot be used with the others.
struct LeftOutClip {
  std::string path, clip, why;
};

class InputReport {
 public:
  InputReport() = default;
  explicit InputReport(const Inputs& inputs);

  /// The clips of a file, whose doubts are kept. A file that cannot be read gives none: one that
  /// was found in a folder is added to what is not read, one that was named is kept for
  /// throwIfFailed.
  std::vector<Clip> read(const InputFile& file, const ReadOptions& options);
  /// To be called where a clip is resampled: frames that are made are told.
  void resample(const Clip& clip, double fps);
  void add(Doubt doubt) { m_doubts.push_back(std::move(doubt)); }
  void leaveOut(const Clip& clip, std::string why);
  void add(const InputReport& other);

  /// Throws InputError naming every file that was named and cannot be read.
  void throwIfFailed() const;
  /// Throws InputError with every reason where files were read and gave no clip that is used.
  void throwIfNone(size_t clips) const;
  const std::vector<Doubt>& doubts() const { return m_doubts; }
  const std::vector<NotRead>& notRead() const { return m_inputs.notRead; }
  const std::vector<LeftOutClip>& leftOut() const { return m_leftOut; }
  /// "2 files not read, 1 clip left out"; empty where nothing is missing.
  std::string missingText() const;
  /// Sentences for people; those of one kind after the third are counted only, but for what is
  /// missing from a clip.
  std::vector<std::string> remarks() const;
  /// Adds "not_read", "other_files" (see Inputs::addTo), "left_out" [{name, path, why}] and
  /// "warnings" [{path, clip, kind, evidence}] where there are any.
  void addTo(Json& result) const;

  void pack(Packer& packer) const;
  static InputReport unpacked(Unpacker& bytes);

 private:
  Inputs m_inputs;  ///< without its files
  std::vector<Doubt> m_doubts;
  std::vector<LeftOutClip> m_leftOut;
  std::vector<std::string> m_failed;
};

}  // namespace marey::io
