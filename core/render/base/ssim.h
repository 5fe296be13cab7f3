// How alike two pictures are: Wang et al. 2004, "Image quality assessment: from error visibility
// to structural similarity", equation 13.
#pragma once

#include "render/base/image.h"

namespace marey::render {

/// Mean structural similarity of the luma of two opaque pictures of the same size, with the
/// paper's 11x11 Gaussian window (sigma 1.5), K1 = 0.01, K2 = 0.03, over all positions where the
/// window fits. 1 means equal; above 0.99 people see no difference, below 0.95 something moved.
/// Throws InputError when the sizes differ or are smaller than the window.
double ssim(const Image& a, const Image& b);

}  // namespace marey::render
