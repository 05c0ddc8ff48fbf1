#include "hbar/adjoint/derivatives/smooth_piece.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/model/model_builder.h"

namespace hbar {
namespace {

/// A ball that falls on the ground from a height: when its lowest point touches depends on that.
Horizon falling_ball() {
  ModelBuilder builder("ball");
  builder.set_gravity({0.0, 0.0, -9.81});
  const int ball = builder.add_link(-1, {.name = "slider", .kind = PrismaticJoint{{0.0, 0.0, 1.0}}},
                                    solid_body("ball", Sphere{0.1}, 100.0));
  Contact contact{.name = "ground", .link = ball, .surface = Plane{}};
  contact.coefficients = {.kn = 1000.0, .kt = 1.0, .mu = 0.5, .damping = 1.0};
  builder.add_contact(contact);
  return Horizon(builder.build(), {}, {.integrator = "bdf1", .h = 0.01, .steps = 20});
}

std::vector<int> piece_from(const Horizon& horizon, double height) {
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0[0] = height;
  const Trajectory trajectory = simulate(horizon, inputs).trajectory();
  return SmoothPieceReader(horizon).read(trajectory, read_values(horizon, trajectory));
}

TEST(SmoothPiece, ChangesWhereAPointTouchesAtAnotherStep) {
  const Horizon horizon = falling_ball();
  const std::vector<int> piece = piece_from(horizon, 0.15);
  EXPECT_EQ(piece, piece_from(horizon, 0.15 + 1e-9));
  EXPECT_NE(piece, piece_from(horizon, 0.2));
  EXPECT_NE(piece, piece_from(horizon, 10.0));
  EXPECT_EQ(piece_from(horizon, 10.0), piece_from(horizon, 11.0));  // never touches
}

}  // namespace
}  // namespace hbar
