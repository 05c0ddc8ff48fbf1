#pragma once

#include "hbar/core/model/model.h"

namespace hbar {

/// Visits the coordinates and controls of a motor: f(coordinate, control).
template <typename F>
void for_each_drive(const Model& model, int motor, const F& f) {
  const CoordinateRange range =
      model.coordinates_of_link(model.motors()[static_cast<std::size_t>(motor)].link);
  for (int c = range.begin; c < range.end; ++c) {
    f(c, model.first_control(motor) + c - range.begin);
  }
}

/// The same for all motors.
template <typename F>
void for_each_drive(const Model& model, const F& f) {
  for (int motor = 0; motor < static_cast<int>(model.motors().size()); ++motor) {
    for_each_drive(model, motor, f);
  }
}

}  // namespace hbar
