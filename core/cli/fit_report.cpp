#include "cli/fit_report.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "io/export_record.h"

namespace marey::cli {

void FitReport::add(const std::optional<FitResidual>& fit) {
  if (!fit) return;
  m_all = m_all ? pooled(*m_all, *fit) : *fit;
}

void FitReport::addTo(Json& result) const {
  if (!m_all) return;
  const Json fit = io::fitJson(*m_all);
  for (const char* key : {"fit_residual_cm", "fit_residual_max_cm"}) result[key] = fit[key];
}

void FitReport::tell(const Context& context) const {
  if (!m_all || context.quiet) return;
  const auto worst = std::max_element(m_all->rmsM.begin(), m_all->rmsM.end());
  fmt::print(stderr,
             "rotations fitted to positions: at most {:.2f} cm off, RMS at most {:.2f} cm ({})\n",
             100.0 * m_all->largestM(), 100.0 * *worst,
             m_all->joints[static_cast<size_t>(worst - m_all->rmsM.begin())]);
}

}  // namespace marey::cli
