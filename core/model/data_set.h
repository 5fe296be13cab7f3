// Training and test data: feature sequences, augmentation, standardiser, windows, provenance.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/job.h"
#include "model/motion_model.h"

namespace marey {

struct PrepareOptions {
  FeatureSpec features;
  double windowS = 4.0;
  double hopS = 2.0;
  bool mirror = true;
  bool reverse = true;
};

/// A window of a sequence: frames [first, first + length) of it; the rest of the window is
/// padding and masked.
struct Window {
  int sequence = 0;
  int first = 0;
  int length = 0;
};

struct DataSet {
  PrepareOptions options;
  std::shared_ptr<const Skeleton> skeleton;  ///< where sequences have no body of their own
  std::vector<float> boneLengthsM;           ///< natural mean per bone, training clips
  std::vector<FeatureSequence> train;        ///< augmented
  std::vector<FeatureSequence> test;         ///< as recorded
  Standardiser standardiser;                 ///< of the augmented training data
  Json provenance;                           ///< sources, options, counts
  std::string hash;

  int poseDim() const { return static_cast<int>(standardiser.poseMean.size()); }
  int controlDim() const { return static_cast<int>(standardiser.controlMean.size()); }
};

/// Augments (mirror, time reversal) and fits the standardiser. A label channel without labels takes
/// those of the training clips, an array without columns those of the first training clip's signal,
/// a skeleton channel the clips' joints; where there is one, every clip keeps its body. Labels and
/// presences are not standardised; what is left out is the mean of what is not. Throws InputError
/// when there is no training clip, clips differ in joints, or control is missing that may not be
/// left out.
DataSet prepareDataSet(const std::vector<Clip>& train, const std::vector<Clip>& test,
                       const PrepareOptions& options, Progress& progress);

/// Windows of `windowFrames` every `hopFrames`; a sequence shorter than a window gives one padded
/// window. A tail that the hops do not reach gives one more window that ends with the sequence.
std::vector<Window> cutWindows(const std::vector<FeatureSequence>& sequences, int windowFrames,
                               int hopFrames);

/// Throws InputError naming sequence and frame where a value is NaN or infinite.
void requireFinite(const std::vector<FeatureSequence>& sequences, const std::string& origin);

/// Of stored data sets; files without one are of version 1.
inline constexpr int kDataSetVersion = 1;

void writeDataSet(const std::filesystem::path& path, const DataSet& data);
/// Throws FileError or InputError.
DataSet readDataSet(const std::filesystem::path& path);

}  // namespace marey
