// Contact against triangle meshes: the grid of a mesh's distance in whole simulations.

#include <gtest/gtest.h>

#include "hbar/adjoint/derivatives/check_gradient.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/geometry/distance_grid.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/model/model_builder.h"
#include "tests/support/solid_meshes.h"

namespace hbar {
namespace {

constexpr double kRadius = 0.1;

/// A small box above a free ball of 10 cm that a spring holds; what the box sees of it is
/// `surface`.
Problem box_on_ball(const ContactSurface& surface, int steps) {
  ModelBuilder builder("mesh", Units::kMetreKilogram);
  builder.set_gravity({0.0, 0.0, -9.81});
  Joint spring{.name = "spring", .kind = TranslationalJoint{}, .damping = 2.0, .stiffness = 300.0};
  const int ball = builder.add_link(-1, spring, solid_body("ball", Sphere{kRadius}, 500.0));
  Body box = solid_body("box", Cuboid{{0.08, 0.08, 0.04}}, 400.0);
  box.contact_points = surface_points(box.shape, {.cuboid = {7, 7, 2}});
  Joint free{.name = "free", .kind = Free3dExpJoint{}};
  free.X_PJ.p.z() = kRadius + 0.02;
  const int link = builder.add_link(-1, free, box);
  builder.add_end_effector({.name = "corner", .link = link, .position = {0.03, 0.02, 0.01}});
  Contact contact{.link = link, .other = ball, .surface = surface};
  contact.coefficients = {.kn = 500.0, .kt = 5.0, .mu = 0.5, .damping = 500.0};
  builder.add_contact(contact);
  const Model model = builder.build();
  SimulationOptions options;
  options.integrator = "bdf2";
  options.h = 0.005;
  options.steps = steps;
  Problem problem{
      Horizon(model, ParameterSet::all(model), options), Objective(squared_variables()), {}};
  problem.inputs = problem.horizon.nominal_inputs();
  problem.inputs.q0 << 0.0, 0.0, 0.0, 0.004, -0.003, -0.001, 0.02, 0.03, 0.05;
  return problem;
}

TEST(MeshContact, MovesLikeTheShapeItsTrianglesApproximate) {
  const auto field = mesh_distance(icosphere(kRadius, 4), 48);
  Problem mesh = box_on_ball(field, 60);
  Problem shape = box_on_ball(OwnShape{}, 60);
  const Trajectory a = simulate(mesh.horizon, mesh.inputs).trajectory();
  const Trajectory b = simulate(shape.horizon, shape.inputs).trajectory();
  const auto touching = contact_history(mesh.horizon, a);
  EXPECT_GT(touching.back()[0].active, 0);
  // Facets of an icosphere of 5120 triangles lie up to 1e-4 of its radius inside.
  EXPECT_LT((a.q - b.q).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT((a.q - b.q).topRows(6).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(MeshContact, HasExactGradients) {
  Problem problem = box_on_ball(mesh_distance(icosphere(kRadius, 3), 32), 30);
  const GradientCheckReport report = check_gradient(problem, {.directions = 1});
  EXPECT_TRUE(report.passed()) << report.table();
}

}  // namespace
}  // namespace hbar
