// What an export did to clips that have positions only, for the user who ran it.
#pragma once

#include <optional>

#include "cli/command.h"
#include "motion/skeleton_fit.h"

namespace marey::cli {

/// The residuals of every fit of one run, pooled over clips.
class FitReport {
 public:
  void add(const std::optional<FitResidual>& fit);
  /// Adds "fit_residual_cm" {joint: RMS} and "fit_residual_max_cm" where a fit was made.
  void addTo(Json& result) const;
  /// One line on stderr where a fit was made, unless --quiet.
  void tell(const Context& context) const;

 private:
  std::optional<FitResidual> m_all;
};

}  // namespace marey::cli
