#include "tests/benchmarks/mujoco_model.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "hbar/adjoint/stage/stage_residual.h"
#include "hbar/core/base/error.h"

namespace hbar::benchmarks {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

mjModel* load(const std::string& mjcf) {
  constexpr const char* kName = "model.xml";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(mjcf.size()));
  const int index = mj_findFileVFS(files.get(), kName);
  std::memcpy(files->filedata[index], mjcf.data(), mjcf.size());
  std::array<char, 1000> message = {};
  mjModel* model = mj_loadXML(kName, files.get(), message.data(), static_cast<int>(message.size()));
  mj_deleteVFS(files.get());
  if (model == nullptr) {
    throw InvalidInput(concat("MuJoCo: ", message.data()));
  }
  return model;
}

}  // namespace

MujocoModel::MujocoModel(const HingeModel& hinges, double h)
    : model_(load(build_mjcf(hinges, h))), data_(mj_makeData(model_.get())) {
  const auto n = static_cast<std::size_t>(model_->nv);
  A_.resize(4 * n * n);
  B_.resize(2 * n * static_cast<std::size_t>(model_->nu));
}

void MujocoModel::set(const Eigen::VectorXd& q, const Eigen::VectorXd& qdot,
                      const Eigen::VectorXd& u) {
  std::copy(q.begin(), q.end(), data_->qpos);
  std::copy(qdot.begin(), qdot.end(), data_->qvel);
  set_control(u);
}

void MujocoModel::set_control(const Eigen::VectorXd& u) {
  std::copy(u.begin(), u.end(), data_->ctrl);
}

void MujocoModel::transition_differences() {
  mjd_transitionFD(model_.get(), data_.get(), 1e-6, 0, A_.data(), B_.data(), nullptr, nullptr);
}

double MujocoModel::gap(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qdot) {
  const int n = model.dof();
  set(q, qdot, Eigen::VectorXd::Zero(n));
  mj_forward(model_.get(), data_.get());
  RowMajor M_mujoco(n, n);
  mj_fullM(model_.get(), M_mujoco.data(), data_->qM);
  const Eigen::Map<const Eigen::VectorXd> bias(data_->qfrc_bias, n);

  StageResidual<double> stage(model);
  StagePoint<double> point(model);
  point.q = q;
  point.qdot = qdot;
  Eigen::VectorXd g(n);
  Eigen::MatrixXd M(n, n);
  stage.linearize(nominal_mechanism<double>(model), point, g);
  stage.jacobian({0.0, 0.0, 1.0}, M);
  return std::max((M - M_mujoco).norm() / M_mujoco.norm(), (g - bias).norm() / bias.norm());
}

}  // namespace hbar::benchmarks
