// The kernels of training, written once over `Lanes`. Part of kernels_body.h.
#pragma once

namespace {

using marey::nn::AdamStep;
using marey::nn::TrainingRows;

inline Lanes sigmoidGradient(Lanes y) {
  return y * (all(1.f) - y);
}

inline Lanes tanhGradient(Lanes y) {
  return all(1.f) - y * y;
}

inline void addTo(float* at, Lanes value) {
  store(at, load(at) + value);
}

inline Lanes loadOrZero(const float* at) {
  return at == nullptr ? all(0.f) : load(at);
}

/// `at` of a matrix that may be missing.
inline const float* place(const float* matrix, long at) {
  return matrix == nullptr ? nullptr : matrix + at;
}

void lstmForward(const TrainingRows& b) {
  const long h = b.units;
  for (long r = 0; r < b.rows; ++r)
    for (long u = 0; u < h; u += kLanes) {
      float* gates = b.gates + r * b.gateStride + u;
      const float* bias = b.bias + u;
      const long at = r * h + u;
      const Lanes in = sigmoid(load(gates) + load(bias)).value(),
                  forget = sigmoid(load(gates + h) + load(bias + h)).value(),
                  fresh = hyperbolicTangent(load(gates + 2 * h) + load(bias + 2 * h)).value(),
                  out = sigmoid(load(gates + 3 * h) + load(bias + 3 * h)).value();
      store(gates, in);
      store(gates + h, forget);
      store(gates + 2 * h, fresh);
      store(gates + 3 * h, out);
      const Lanes cell = fma(forget, loadOrZero(place(b.previous, at)), in * fresh);
      store(b.cell + at, cell);
      store(b.hidden + at, out * hyperbolicTangent(cell).value());
    }
}

void lstmBackward(const TrainingRows& b) {
  const long h = b.units;
  for (long r = 0; r < b.rows; ++r)
    for (long u = 0; u < h; u += kLanes) {
      float* gates = b.gates + r * b.gateStride + u;
      float* sums = b.biasGradient + u;
      const long at = r * h + u;
      const Lanes in = load(gates), forget = load(gates + h), fresh = load(gates + 2 * h),
                  out = load(gates + 3 * h), grown = hyperbolicTangent(load(b.cell + at)).value(),
                  gradient = load(b.gradient + at);
      const Lanes cell = fma(gradient * out, tanhGradient(grown), load(b.carried + at));
      store(b.carried + at, cell * forget);
      const Lanes ofIn = cell * fresh * sigmoidGradient(in),
                  ofForget = cell * loadOrZero(place(b.previous, at)) * sigmoidGradient(forget),
                  ofFresh = cell * in * tanhGradient(fresh),
                  ofOut = gradient * grown * sigmoidGradient(out);
      store(gates, ofIn);
      store(gates + h, ofForget);
      store(gates + 2 * h, ofFresh);
      store(gates + 3 * h, ofOut);
      addTo(sums, ofIn);
      addTo(sums + h, ofForget);
      addTo(sums + 2 * h, ofFresh);
      addTo(sums + 3 * h, ofOut);
    }
}

void gruForward(const TrainingRows& b) {
  const long h = b.units;
  for (long r = 0; r < b.rows; ++r)
    for (long u = 0; u < h; u += kLanes) {
      float* gates = b.gates + r * b.gateStride + u;
      const float* bias = b.bias + u;
      const long at = r * h + u;
      const Lanes reset = sigmoid(load(gates) + load(bias)).value(),
                  update = sigmoid(load(gates + h) + load(bias + h)).value();
      const Lanes given = load(gates + 2 * h) + load(bias + 2 * h);
      const Lanes fresh = hyperbolicTangent(fma(reset, load(b.fromState + at), given)).value();
      store(gates, reset);
      store(gates + h, update);
      store(gates + 2 * h, fresh);
      store(b.hidden + at, fma(update, loadOrZero(place(b.previous, at)) - fresh, fresh));
    }
}

void gruBackward(const TrainingRows& b) {
  const long h = b.units;
  for (long r = 0; r < b.rows; ++r)
    for (long u = 0; u < h; u += kLanes) {
      float* gates = b.gates + r * b.gateStride + u;
      float* sums = b.biasGradient + u;
      const long at = r * h + u;
      const Lanes reset = load(gates), update = load(gates + h), fresh = load(gates + 2 * h),
                  gradient = load(b.gradient + at);
      const Lanes old = loadOrZero(place(b.previous, at));
      const Lanes ofFresh = gradient * (all(1.f) - update) * tanhGradient(fresh),
                  ofUpdate = gradient * (old - fresh) * sigmoidGradient(update),
                  ofReset = ofFresh * load(b.fromState + at) * sigmoidGradient(reset),
                  ofState = ofFresh * reset;
      if (b.carried != nullptr) addTo(b.carried + at, gradient * update);
      store(gates, ofReset);
      store(gates + h, ofUpdate);
      store(gates + 2 * h, ofFresh);
      store(b.fromState + at, ofState);
      addTo(sums, ofReset);
      addTo(sums + h, ofUpdate);
      addTo(sums + 2 * h, ofFresh);
      addTo(sums + 3 * h, ofState);
    }
}

void adam(const AdamStep& a) {
  const Lanes keepMean = all(a.beta1), keepSquare = all(a.beta2), addMean = all(a.rest1),
              addSquare = all(a.rest2), scale = all(a.gradientScale), limit = all(a.limit),
              rate = all(a.rate), squareScale = all(a.squareScale), epsilon = all(a.epsilon);
  for (long i = 0; i < a.blocks * kLanes; i += kLanes) {
    const Lanes raw = load(a.gradient + i);
    const Lanes gradient = withSignOf(smaller(magnitude(raw), limit), raw) * scale;
    const Lanes mean = fma(keepMean, load(a.mean + i), addMean * gradient);
    const Lanes square = fma(keepSquare, load(a.square + i), addSquare * gradient * gradient);
    store(a.mean + i, mean);
    store(a.square + i, square);
    const Lanes below = fma(squareRoot(square), squareScale, epsilon);
    store(a.parameter + i, load(a.parameter + i) - rate * mean / below);
  }
}

}  // namespace
