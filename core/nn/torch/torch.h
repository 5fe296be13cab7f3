// The one place where libtorch is included: a precompiled header for nn, model and families.
#pragma once

#include <torch/torch.h>
