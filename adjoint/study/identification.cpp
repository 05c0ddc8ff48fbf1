#include "hbar/adjoint/study/identification.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/adjoint/terms/value_access.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"

namespace hbar::study {
namespace {

void check_data(const TrajectoryData& data, const char* where) {
  if (data.data.size() != static_cast<Eigen::Index>(data.places.size())) {
    throw InvalidInput(
        concat(where, ": ", data.data.size(), " data for ", data.places.size(), " places"));
  }
  if (!data.data.allFinite()) {
    throw InvalidInput(concat(where, ": a datum is not finite"));
  }
}

Eigen::VectorXd sigma_of_each(const Eigen::VectorXd& sigma, const TrajectoryData& data,
                              const char* where) {
  if (sigma.size() != 1 && sigma.size() != data.data.size()) {
    throw InvalidInput(concat(where, ": ", sigma.size(), " standard deviations for ",
                              data.data.size(), " data; one for each, or one for all"));
  }
  if (!sigma.allFinite() || (sigma.array() <= 0.0).any()) {
    throw InvalidInput(concat(where, ": a standard deviation is not positive and finite"));
  }
  return sigma.size() == 1 ? Eigen::VectorXd::Constant(data.data.size(), sigma[0]) : sigma;
}

class MeasuredDataTerm final : public ObjectiveTerm {
 public:
  MeasuredDataTerm(const TrajectoryData& data, const Eigen::VectorXd& sigma, double weight)
      : places_(data.places), data_(data.data) {
    check_data(data, "measured_data_term");
    if (!std::isfinite(weight)) {
      throw InvalidInput("measured_data_term: the weight is not finite");
    }
    weights_ = weight * sigma_of_each(sigma, data, "measured_data_term").cwiseAbs2().cwiseInverse();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      add_second(places_[i], weights_[at(i)]);
    }
  }

  [[nodiscard]] std::string name() const override { return "measured data"; }
  [[nodiscard]] double value(const TrajectoryValues& values) const override {
    double sum = 0.0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const double gap = value_at(values, places_[i]) - data_[at(i)];
      sum += weights_[at(i)] * gap * gap;
    }
    return 0.5 * sum;
  }
  void add_partials(const TrajectoryValues& values, TrajectoryPartials& partials) const override {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const double gap = value_at(values, places_[i]) - data_[at(i)];
      partial_at(partials, places_[i]) += weights_[at(i)] * gap;
    }
  }
  [[nodiscard]] std::vector<SecondPlace> second_places(const TrajectoryValues&) const override {
    return second_places_;
  }
  void second_partials(const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd> second) const override {
    second = Eigen::Map<const Eigen::VectorXd>(second_.data(),
                                               static_cast<Eigen::Index>(second_.size()));
  }

 private:
  static Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }
  /// A place that was measured twice is listed once, with the sum.
  void add_second(const ValuePlace& place, double weight) {
    const std::vector<int> key = {static_cast<int>(place.field), place.step, place.index};
    const auto [slot, is_new] = slots_.try_emplace(key, second_.size());
    if (is_new) {
      second_places_.push_back({.row = 0, .a = place, .b = place});
      second_.push_back(0.0);
    }
    second_[slot->second] += weight;
  }

  std::vector<ValuePlace> places_;
  Eigen::VectorXd data_;
  Eigen::VectorXd weights_;  // weight / σ²
  std::vector<SecondPlace> second_places_;
  std::vector<double> second_;
  std::map<std::vector<int>, std::size_t> slots_;
};

/// The row of `block`, which has a row per step and index, at a place.
Eigen::RowVectorXd tangent_row(const Eigen::MatrixXd& block, Eigen::Index rows,
                               const ValuePlace& place) {
  return block.row(place.step * rows + place.index);
}

/// How the number at a place changes along each direction.
Eigen::RowVectorXd place_sensitivity(const TrajectoryValues& values, const Tangents& tangents,
                                     const Directions& directions, const ValuePlace& place) {
  (void)value_at(values, place);  // refuses a place that does not exist
  const Eigen::Index rows = field_rows(values, place.field);
  switch (place.field) {
    case ValueField::kQ:
      return tangent_row(tangents.q, rows, place);
    case ValueField::kQdot:
      return tangent_row(tangents.qdot, rows, place);
    case ValueField::kMeasured:
      return tangent_row(tangents.measured, rows, place);
    case ValueField::kU:
      return tangent_row(directions.u, rows, place);
    case ValueField::kP:
      break;
  }
  return directions.p.row(place.index);
}

void check_parameters(const Trajectory& trajectory, const DesignMap& map,
                      const Eigen::VectorXd& d) {
  if (d.size() != map.variables().size()) {
    throw InvalidInput(concat("data_sensitivity: ", d.size(), " design variables; the map has ",
                              map.variables().size()));
  }
  const Eigen::VectorXd p = map.parameters(d);
  if (p.size() != trajectory.inputs.p.size() || !p.isApprox(trajectory.inputs.p, 1e-12)) {
    throw InvalidInput("data_sensitivity: the trajectory was not computed with map.parameters(d)");
  }
}

}  // namespace

std::shared_ptr<const ObjectiveTerm> measured_data_term(const TrajectoryData& data,
                                                        const Eigen::VectorXd& sigma,
                                                        double weight) {
  return std::make_shared<MeasuredDataTerm>(data, sigma, weight);
}

Eigen::MatrixXd data_sensitivity(const Horizon& horizon, const Trajectory& trajectory,
                                 const DesignMap& map, const Eigen::VectorXd& d,
                                 const TrajectoryData& data, bool initial_state) {
  check_data(data, "data_sensitivity");
  check_parameters(trajectory, map, d);
  const Eigen::Index dof = horizon.model().dof();
  Directions directions =
      Directions::zero(horizon, d.size() + (initial_state ? 2 * dof : Eigen::Index{0}));
  directions.p.leftCols(d.size()) = map.jacobian(d);
  if (initial_state) {
    directions.q0.middleCols(d.size(), dof).setIdentity();
    directions.qdot0.rightCols(dof).setIdentity();
  }
  const Tangents tangents = TangentSweep(horizon).push_forward(trajectory, directions);
  const TrajectoryValues values = read_values(horizon, trajectory);
  Eigen::MatrixXd out(data.data.size(), directions.count());
  for (std::size_t i = 0; i < data.places.size(); ++i) {
    out.row(static_cast<Eigen::Index>(i)) =
        place_sensitivity(values, tangents, directions, data.places[i]);
  }
  return out;
}

Information fisher_information(const Horizon& horizon, const Trajectory& trajectory,
                               const DesignMap& map, const Eigen::VectorXd& d,
                               const TrajectoryData& data, const Eigen::VectorXd& sigma,
                               const IdentificationOptions& options) {
  const DesignVariables& variables = map.variables();
  Fit fit;
  fit.sensitivity = data_sensitivity(horizon, trajectory, map, d, data, options.initial_state);
  fit.sigma = sigma_of_each(sigma, data, "fisher_information");
  const TrajectoryValues values = read_values(horizon, trajectory);
  fit.residual.resize(data.data.size());
  for (Eigen::Index i = 0; i < data.data.size(); ++i) {
    fit.residual[i] = value_at(values, data.places[static_cast<std::size_t>(i)]) - data.data[i];
  }
  fit.names = variables.names;
  const Eigen::Index k = fit.sensitivity.cols();
  fit.estimate.setZero(k);
  fit.scale.setOnes(k);
  fit.estimate.head(d.size()) = d;
  fit.scale.head(d.size()) = variables.scale;
  if (options.initial_state) {
    const TrajectoryNames names = trajectory_names(horizon);
    for (const std::string& name : names.q) {
      fit.names.push_back("initial " + name);
    }
    for (const std::string& name : names.qdot) {
      fit.names.push_back("initial " + name);
    }
    const Eigen::Index dof = horizon.model().dof();
    fit.estimate.segment(d.size(), dof) = trajectory.inputs.q0;
    fit.estimate.tail(dof) = trajectory.inputs.qdot0;
  }
  return information(fit, options.information);
}

}  // namespace hbar::study
