#include "hbar/adjoint/value_numbers.h"

namespace hbar {
namespace {

/// The same of values and of partials, which have the same members.
template <typename T>
auto& find_number(T& all, const ValuePlace& place) {
  switch (place.field) {
    case ValueField::kQ:
      return all.q(place.index, place.step);
    case ValueField::kQdot:
      return all.qdot(place.index, place.step);
    case ValueField::kV:
      return all.v(place.index, place.step);
    case ValueField::kTactile:
      return all.tactile(place.index, place.step);
    case ValueField::kMeasured:
      return all.measured(place.index, place.step);
    case ValueField::kU:
      return all.u(place.index, place.step);
    case ValueField::kP:
      break;
  }
  return all.p[place.index];
}

}  // namespace

TrajectoryValues value_shape(const Simulator& simulator) {
  const Model& model = simulator.model();
  const int steps = simulator.options().steps;
  TrajectoryValues out;
  out.h = simulator.options().h;
  out.q.setZero(model.dof(), steps + 1);
  out.qdot.setZero(model.dof(), steps + 1);
  out.v.setZero(model.variable_count(), steps + 1);
  out.tactile.setZero(model.tactile_count(), steps + 1);
  out.measured.setZero(simulator.measured_count(), steps + 1);
  out.u.setZero(model.control_count(), steps);
  out.p.setZero(simulator.parameters().size());
  return out;
}

double number_at(const TrajectoryValues& values, const ValuePlace& place) {
  return find_number(values, place);
}

double number_at(const TrajectoryPartials& partials, const ValuePlace& place) {
  return find_number(partials, place);
}

double& number_at(TrajectoryPartials& partials, const ValuePlace& place) {
  return find_number(partials, place);
}

void add_second_order(const std::vector<SecondPlace>& places,
                      const Eigen::Ref<const Eigen::VectorXd>& second, const ValueTangent& tangent,
                      TrajectoryPartials& out) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const SecondPlace& at = places[i];
    const double value = second[static_cast<Eigen::Index>(i)];
    number_at(out, at.a) += value * number_at(tangent, at.b);
    if (!(at.a == at.b)) {
      number_at(out, at.b) += value * number_at(tangent, at.a);
    }
  }
}

}  // namespace hbar
