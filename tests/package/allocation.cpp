// Matrices that the library allocates and this program resizes, and the reverse: both must allocate
// alike, whatever machine each was compiled for. Exits with 1 if a number changed on the way.
#include <cstdio>

#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/model/model_builder.h"

namespace {

hbar::Model cart() {
  hbar::ModelBuilder builder("cart");
  builder.add_link(-1, {.name = "rail", .kind = hbar::PrismaticJoint{{1.0, 0.0, 0.0}}},
                   hbar::solid_body("cart", hbar::Cuboid{{0.1, 0.1, 0.1}}, 1000.0));
  builder.add_motor({.link = 0});
  return builder.build();
}

bool counts_up(const Eigen::MatrixXd& u) {
  for (Eigen::Index k = 0; k < u.cols(); ++k) {
    if (u(0, k) != static_cast<double>(k + 1)) {
      return false;
    }
  }
  return true;
}

}  // namespace

int main() {
  const hbar::Model model = cart();
  int wrong = 0;
  int resized = 0;
  for (int N = 2; N < 400; N += 3) {
    const hbar::Horizon horizon(model, {}, {.integrator = "bdf2", .h = 0.01, .steps = N});
    for (int M = 1; M < 400; M += 7) {
      hbar::Inputs inputs = horizon.nominal_inputs();
      for (int k = 0; k < N; ++k) {
        inputs.u(0, k) = k + 1.0;
      }
      inputs.u.conservativeResize(1, M);
      wrong += !counts_up(inputs.u.leftCols(M < N ? M : N));
      ++resized;
    }
    // The reverse: what is allocated here, the library assigns to and frees.
    hbar::Inputs inputs = horizon.nominal_inputs();
    inputs.u = Eigen::MatrixXd::Ones(1, N);
    hbar::Trajectory trajectory = simulate(horizon, inputs).trajectory();
    trajectory.q.conservativeResize(1, 1);
    wrong += trajectory.q(0, 0) != 0.0;
    inputs = trajectory.inputs;
    inputs.u.conservativeResize(1, 1);
    wrong += inputs.u(0, 0) != 1.0;
  }
  std::printf("allocation: %d of %d matrices wrong\n", wrong, resized);
  return wrong == 0 ? 0 : 1;
}
