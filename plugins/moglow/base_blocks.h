// A pose base in blocks of a fixed number of rows, each on one thread: libtorch and BLAS choose
// their way by shape and thread count, so that only fixed shapes give a row the same bits whatever
// the batch. No libtorch type appears here.
#pragma once

#include <memory>
#include <vector>

namespace marey::moglow {

class PoseBase;
struct Foresight;

class BaseBlocks {
 public:
  static constexpr long kRows = 32;

  explicit BaseBlocks(std::shared_ptr<const PoseBase> base);

  /// What the base makes of `rows` frames, kept for the way back.
  struct Seen {
    long rows = 0;
    std::shared_ptr<const std::vector<Foresight>> blocks;
  };
  /// history [rows, historyWidth] and control [rows, controlWidth], standardised, row by row.
  /// Features go to `features`, `stride` floats from row to row.
  Seen foresee(long rows, const float* history, long historyWidth, const float* control,
               long controlWidth, float* features, long stride) const;
  /// Innovations [rows, width] to standardised poses [rows, width].
  void toPose(const Seen& seen, const float* innovation, float* pose, long width) const;
  /// Standardised poses to innovations [rows, width] and log-determinants [rows].
  void toInnovation(const Seen& seen, const float* pose, float* innovation, long width,
                    double* logDet) const;

 private:
  std::shared_ptr<const PoseBase> m_base;
};

}  // namespace marey::moglow
