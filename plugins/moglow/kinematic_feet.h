// What the kinematic base knows of feet: how firmly each is held and how far it goes otherwise,
// looked up by clusters of its recent movement and its place under the body. Internal (libtorch
// types).
#pragma once

#include "moglow/kinematic_features.h"

namespace marey::moglow {

class KinematicFeet {
 public:
  KinematicFeet(const Config& config, const KinematicBody& body, const BufferMaker& buffer);

  torch::Tensor clustersOf(const KinematicBody& body, const Past& past) const;  ///< int64 [N, feet]
  /// With feet held, for a body whose pose without hold is foreseen as `pose`.
  Foreseen foreseen(const KinematicBody& body, const Past& past, const torch::Tensor& pose,
                    const torch::Tensor& clusters) const;
  /// `predicted`: chart coordinates [N, D].
  FootGate gate(const KinematicBody& body, const Past& past, const torch::Tensor& clusters,
                const torch::Tensor& predicted) const;

  /// What the fits of gates and legs look at: frames as they are foreseen, and where feet went.
  struct Footing {
    torch::Tensor clusters;  ///< [N, feet]
    Foreseen foreseen;
    FootGate gate;  ///< with the tables as they were when it was made
    FootPlaces places;
    torch::Tensor scales;  ///< [N, feet]
  };
  /// Heights and reaches that are not left; poses [N, J, 3] in centimetres here and below.
  void fitLimits(const KinematicBody& body, const torch::Tensor& pose, const Past& past);
  /// Clusters of a foot's movement, and how far each is held; `step`: as `pose` of foreseen.
  void fitHold(const KinematicBody& body, const torch::Tensor& pose, const Past& past,
               const torch::Tensor& step);
  /// `floor`: smallest standard deviation of a joint's coordinate, cm; 0: none.
  void fitGate(const Footing& footing, double floor);
  /// How far knees leave the bend of their legs, and feet the lengths of their bones: with the
  /// distance that the foot goes.
  void fitLegs(const KinematicBody& body, const torch::Tensor& pose, const Footing& footing,
               double floor);

 private:
  int64_t m_clusters;
  // By cluster.
  torch::Tensor m_centres, m_hold, m_skew, m_radii, m_kneeSlope, m_boneSlope, m_slack;
  torch::Tensor m_floor, m_reach;  ///< [feet], cm: lowest height, longest way to the hip
  torch::Tensor m_slowMovement;    ///< cm: what counts as slow for a foot in a frame
};

}  // namespace marey::moglow
