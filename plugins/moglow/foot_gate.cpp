#include "moglow/foot_gate.h"

#include <algorithm>
#include <cmath>

namespace marey::moglow {
namespace {

/// The segment of a piecewise linear function through the origin; the last one goes on for ever.
struct Segment {
  torch::Tensor start;  ///< [N]: radius where it starts
  torch::Tensor slope;  ///< [N]: cm per unit of rho
  torch::Tensor rho;    ///< [N]: rho where it starts
};

Segment segmentAt(const torch::Tensor& radii, const torch::Tensor& index) {
  const auto starts = torch::cat({torch::zeros_like(radii.narrow(1, 0, 1)), radii}, 1);
  const auto at = index.clamp(0, kGateKnots - 1).unsqueeze(1);
  const auto start = starts.gather(1, at).squeeze(1);
  return {start, (starts.gather(1, at + 1).squeeze(1) - start) / kGateStep,
          at.squeeze(1) * kGateStep};
}

torch::Tensor lengthOf(const torch::Tensor& v) {
  return v.norm(2, -1).clamp_min(1e-9);
}

}  // namespace

torch::Tensor gateDistance(const torch::Tensor& offset, const torch::Tensor& shift) {
  const auto along = (offset * shift).sum(-1), rest = 1.0 - shift.square().sum(-1);
  const auto root = (along.square() + rest * offset.square().sum(-1)).clamp_min(1e-24).sqrt();
  // Of the two equal forms of the root, the one that does not cancel.
  return torch::where(along > 0.0, offset.square().sum(-1) / (root + along).clamp_min(1e-12),
                      (root - along) / rest);
}

Gated throughGate(const Gate& gate, const torch::Tensor& offset) {
  const auto s = gateDistance(offset, gate.shift).clamp_min(1e-9);
  const auto towards = offset / s.unsqueeze(-1) - gate.shift;
  const auto direction = towards / lengthOf(towards).unsqueeze(-1);
  const auto segment = segmentAt(gate.radii, gate.radii.le(s.unsqueeze(1)).sum(1));
  const auto rho = segment.rho + (s - segment.start) / segment.slope;
  const auto logDet = (rho / s).log() - segment.slope.log() -
                      (1.0 + (direction * gate.shift).sum(-1)).clamp_min(1e-6).log();
  return {direction * rho.unsqueeze(-1), logDet};
}

torch::Tensor gateRadius(const torch::Tensor& radii, const torch::Tensor& rho) {
  const auto segment = segmentAt(radii, (rho / kGateStep).floor().to(torch::kInt64));
  return segment.start + (rho - segment.rho) * segment.slope;
}

torch::Tensor backThroughGate(const Gate& gate, const torch::Tensor& value) {
  const auto rho = lengthOf(value);
  return gateRadius(gate.radii, rho).unsqueeze(-1) * (value / rho.unsqueeze(-1) + gate.shift);
}

torch::Tensor gateQuantiles(const torch::Tensor& distances, double floor, double far) {
  const auto sorted = std::get<0>(distances.to(torch::kCPU).to(torch::kFloat64).sort());
  const auto count = static_cast<double>(sorted.size(0));
  auto out = torch::empty({kGateKnots}, torch::kFloat64);
  double last = 0.0;
  for (int i = 0; i + 1 < kGateKnots; ++i) {
    const double rho = kGateStep * (i + 1);
    const double at = (1.0 - std::exp(-0.5 * rho * rho)) * count - 0.5;
    const double low = std::clamp(std::floor(at), 0.0, count - 1.0);
    const auto index = static_cast<int64_t>(low);
    const auto next = std::min<int64_t>(index + 1, sorted.size(0) - 1);
    const double below = sorted[index].item<double>();
    const double value =
        below + std::clamp(at - low, 0.0, 1.0) * (sorted[next].item<double>() - below);
    last = std::max(value, last + floor);
    out[i] = last;
  }
  out[kGateKnots - 1] = std::max(2.0 * last, far);
  return out.to(distances.options());
}

}  // namespace marey::moglow
