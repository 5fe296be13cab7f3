// Exponential maps of joint rotations relative to the rest pose: the root's position in the root
// frame (3 values, metres), its rotation relative to the root frame (3, radians), then every other
// joint's local rotation (3 each, radians). Source of the parametrisation: Grassia 1998, "Practical
// parameterization of rotations using the exponential map".
//
// With r_j the rest pose's local rotation of a joint and q_j its local rotation in a frame (of the
// root: the world rotation seen from the root frame), a joint's values are log(r_j^-1 q_j), with
// the whole turns that make curves continuous in time. Bones are the skeleton's, whatever the
// values.
#pragma once

#include "motion/representation/representation.h"

namespace marey {

Representation jointExpmap();

}  // namespace marey
