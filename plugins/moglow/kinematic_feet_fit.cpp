// How the tables of feet are fitted to motion.
#include <algorithm>
#include <numbers>

#include "moglow/clusters.h"
#include "moglow/kinematic_feet.h"

namespace marey::moglow {
namespace {

constexpr double kSlack = 0.01;      ///< cm that a leg may err over a resting foot
constexpr double kSteadiest = 0.05;  ///< smallest scale of a leg's errors, relative to the foot's
constexpr double kLowest = 0.005;    ///< share of frames in which a foot is lower than its floor
constexpr double kSlowest = 0.1;    ///< share of frames in which a foot is slower than slow by half
constexpr double kReached = 0.995;  ///< share of frames in which a leg reaches less far
constexpr double kSmallestStep = 0.02;  ///< between radial quantiles, in units of the scale
constexpr int64_t kFewestMoves = 60;    ///< of a cluster of its own gate

/// What feet did, one row per foot and frame: chart coordinates [N, 3], where the rest of the body
/// foresees them [N, 2], and scales [N]; cm.
struct FootMoves {
  torch::Tensor now, before, way, foreseen, scale;
  FootMoves at(const torch::Tensor& rows) const {
    const auto pick = [&](const torch::Tensor& t) { return t.index_select(0, rows); };
    return {pick(now), pick(before), pick(way), pick(foreseen), pick(scale)};
  }
};

/// One foot's frames after the other's, from [N, feet, ...].
torch::Tensor footByFoot(const torch::Tensor& t) {
  return t.transpose(0, 1).flatten(0, 1);
}

torch::Tensor offsets(const FootMoves& moves, double hold) {
  return moves.now.narrow(-1, 0, 2) -
         gateCentre(torch::full_like(moves.scale, hold), moves.foreseen, moves.before);
}

/// How far feet are held to their last place: the centre that makes the mean log distance
/// smallest. It is robust and drawn to sharp peaks.
double likeliestHold(const FootMoves& moves) {
  double best = 1e30, out = 0.0;
  for (const double hold : {0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0}) {
    const double value = (offsets(moves, hold).norm(2, -1) + 0.05).log().mean().item<double>();
    if (value >= best) continue;
    best = value;
    out = hold;
  }
  return out;
}

struct FittedGate {
  double skew = 0.0;
  torch::Tensor radii;  ///< [kGateKnots], in units of the scale
};

/// Steps between radial quantiles, in units of the scale, with which no direction of a gate is
/// narrower than noise of `floor` cm on every coordinate makes it. A foot is seen from where it
/// stood as far as it is held, and from its knee, which is as noisy, as far as it is not. Against
/// the way of its shift a gate is narrower by 1 - |skew|.
double smallestStep(const FootMoves& moves, double hold, double skew, double floor) {
  const double noise = floor * std::sqrt(1.0 + (1.0 - hold) * (1.0 - hold));
  const double scale = moves.scale.min().item<double>();
  return std::max(kSmallestStep, kGateStep * noise / ((1.0 - std::abs(skew)) * scale));
}

/// The gate about given centres under which the movements are likeliest; `far` as in
/// gateQuantiles, `floor` as in smallestStep.
FittedGate likeliestGate(const FootMoves& moves, double hold, double far, double floor) {
  FittedGate best;
  double most = -1e30;
  const auto offset = offsets(moves, hold);
  for (const double skew : {-0.8, -0.5, -0.2, 0.0, 0.2, 0.5, 0.8}) {
    const auto shift = gateShift(torch::full_like(moves.scale, skew), moves.way);
    const auto radii = gateQuantiles(gateDistance(offset, shift) / moves.scale,
                                     smallestStep(moves, hold, skew, floor), far);
    const auto gated = throughGate({radii.unsqueeze(0) * moves.scale.unsqueeze(1), shift}, offset);
    const double nats = (gated.logDet - 0.5 * gated.value.square().sum(-1)).mean().item<double>();
    if (nats <= most) continue;
    most = nats;
    best = {skew, radii};
  }
  return best;
}

torch::Tensor quantileOf(const torch::Tensor& values, double share) {
  const auto sorted = std::get<0>(values.flatten().sort());
  return sorted[static_cast<int64_t>(share * static_cast<double>(sorted.size(0) - 1))];
}

}  // namespace

void KinematicFeet::fitLimits(const KinematicBody& body, const torch::Tensor& pose,
                              const Past& past) {
  const auto feet = torch::tensor(body.feet(), torch::kInt64).to(pose.device());
  const auto movement =
      (past.poses.select(1, 0) - past.poses.select(1, 1)).index_select(1, feet).norm(2, -1);
  const auto trained = pose / past.size.unsqueeze(-1);
  m_slowMovement.copy_((2.0 * quantileOf(movement, kSlowest)).clamp(0.05, 0.3));
  for (size_t f = 0; f < body.feet().size(); ++f) {
    const auto foot = trained.select(1, body.feet()[f]);
    m_floor[static_cast<int64_t>(f)] = quantileOf(foot.select(1, 1), kLowest);
    m_reach[static_cast<int64_t>(f)] =
        quantileOf((foot - trained.select(1, body.hips()[f])).norm(2, -1), kReached);
  }
}

void KinematicFeet::fitHold(const KinematicBody& body, const torch::Tensor& pose, const Past& past,
                            const torch::Tensor& step) {
  std::vector<torch::Tensor> features;
  for (size_t f = 0; f < body.feet().size(); ++f)
    features.push_back(footFeatures(body, past, f, m_slowMovement));
  m_centres.copy_(clusterCentres(torch::cat(features), m_clusters));
  m_hold.zero_();
  const auto clusters = clustersOf(body, past), cluster = footByFoot(clusters);
  const auto places = footPlaces(body.chart(), pose, foreseen(body, past, step, clusters));
  const auto now = footByFoot(places.now);
  const FootMoves moves{now, footByFoot(places.before), footByFoot(places.way),
                        torch::zeros_like(now.narrow(1, 0, 2)), footByFoot(footScales(body, past))};
  for (int64_t k = 0; k < m_clusters; ++k) {
    const auto rows = cluster.eq(k).nonzero().squeeze(1);
    if (rows.size(0) > 0) m_hold[k] = likeliestHold(moves.at(rows));
  }
}

void KinematicFeet::fitGate(const Footing& f, double floor) {
  const FootMoves moves{footByFoot(f.places.now), footByFoot(f.places.before),
                        footByFoot(f.places.way), footByFoot(f.gate.foreseen),
                        footByFoot(f.scales)};
  const auto cluster = footByFoot(f.clusters);
  const FittedGate common = likeliestGate(moves, 0.5, 0.0, floor);
  // What feet do at large is what any foot may do once in a while.
  const double far = common.radii[kGateKnots - 2].item<double>();
  for (int64_t k = 0; k < m_clusters; ++k) {
    const auto rows = cluster.eq(k).nonzero().squeeze(1);
    const FittedGate fitted =
        rows.size(0) < kFewestMoves
            ? common
            : likeliestGate(moves.at(rows), m_hold[k].item<double>(), far, floor);
    m_skew[k] = fitted.skew;
    m_radii[k].copy_(fitted.radii);
  }
}

void KinematicFeet::fitLegs(const KinematicBody& body, const torch::Tensor& pose, const Footing& f,
                            double floor) {
  const auto& clusters = f.clusters;
  const auto distance = gateDistance(
      f.places.now.narrow(-1, 0, 2) - gateCentre(f.foreseen.hold, f.gate.foreseen, f.places.before),
      gateShift(m_skew.index({clusters}), f.places.way));
  const auto bent =
      chartCoordinates(body.chart(), pose, f.foreseen)
          .index_select(1, torch::tensor(body.knees(), torch::kInt64).to(pose.device()))
          .select(-1, 1);
  const auto offset = (bent - (1.0 - firmness(f.foreseen.hold)) * f.gate.knee).abs();
  const auto excess =
      footExcess(f.places.now, f.places.before,
                 f.foreseen.lengths.index_select(
                     1, torch::tensor(body.feet(), torch::kInt64).to(pose.device())),
                 f.foreseen.hold, distance);
  for (int64_t k = 0; k < m_clusters; ++k) {
    const auto rows = clusters.eq(k);
    if (!rows.any().item<bool>()) continue;
    const auto s = distance.masked_select(rows);
    const auto slack = std::max(kSlack, floor) + (1.0 - firmness(m_hold[k])) * s.median();
    // Bones end in two joints, each as noisy as the other.
    const double steadiest =
        std::max(kSteadiest, std::numbers::sqrt2 * floor / slack.item<double>());
    const auto slope = [&](const torch::Tensor& values) {
      const auto relative = values.masked_select(rows) / (s + slack);
      return relative.square().mean().sqrt().clamp(steadiest, std::max(4.0, steadiest));
    };
    m_slack[k] = slack;
    m_kneeSlope[k] = slope(offset);
    m_boneSlope[k] = slope(excess);
  }
}

}  // namespace marey::moglow
