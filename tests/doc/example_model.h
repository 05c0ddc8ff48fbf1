#pragma once

#include <gtest/gtest.h>

#include <string>

#include "hbar/hbar.h"

namespace hbar::testing {

/// The model of a scene in examples/scenes.
[[nodiscard]] inline Model example_model(const std::string& scene) {
  return scene::load_model(HBAR_SOURCE_DIR "/examples/scenes/" + scene).model;
}

/// Two gradients with respect to parameters and controls are the same, and not 0.
inline void expect_same(const Gradient& one, const Gradient& other) {
  EXPECT_GT(one.p.norm(), 1e-3);
  EXPECT_LT((other.p - one.p).norm(), 1e-9 * one.p.norm());
  EXPECT_LT((other.u - one.u).norm(), 1e-9 * one.u.norm());
}

}  // namespace hbar::testing
