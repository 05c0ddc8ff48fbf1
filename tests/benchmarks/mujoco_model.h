#pragma once

#include <mujoco/mujoco.h>

#include <memory>

#include "tests/benchmarks/hinges.h"

namespace hbar::benchmarks {

/// A mechanism in MuJoCo, with its state.
class MujocoModel {
 public:
  /// @throws InvalidInput with MuJoCo's message if it does not accept the description
  MujocoModel(const HingeModel& hinges, double h);

  /// Sets the state and the controls.
  void set(const Eigen::VectorXd& q, const Eigen::VectorXd& qdot, const Eigen::VectorXd& u);

  /// Sets the controls alone.
  void set_control(const Eigen::VectorXd& u);

  /// mj_step: semi-implicit Euler.
  void step() { mj_step(model_.get(), data_.get()); }

  /// mjd_transitionFD, forward differences of the next state: A by state, B by control. Leaves the
  /// state as it is.
  void transition_differences();

  /// Largest relative difference of mass matrix and bias forces (at a = 0, u = 0) from hbar's.
  [[nodiscard]] double gap(const Model& model, const Eigen::VectorXd& q,
                           const Eigen::VectorXd& qdot);

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
  std::vector<mjtNum> A_;
  std::vector<mjtNum> B_;
};

}  // namespace hbar::benchmarks
