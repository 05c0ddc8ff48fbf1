// What every transcription's Hessian begins with: the terms' second partials.
#include "hbar/adjoint/programs/transcription.h"
#include "hbar/adjoint/terms/value_access.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"

namespace hbar {

Transcription::HessianPlan& Transcription::plan(solvers::HessianKind kind) {
  if (kind == solvers::HessianKind::kLimitedMemory) {
    throw InvalidInput("transcription: a limited-memory Hessian is the optimiser's own");
  }
  std::optional<HessianPlan>& kept = kind == solvers::HessianKind::kExact ? exact_ : gauss_newton_;
  if (!kept) {
    kept = make_plan(kind);
  }
  return *kept;
}

Transcription::HessianPlan Transcription::make_plan(solvers::HessianKind kind) const {
  HessianPlan out;
  out.objective = problem_.objective.second_places(value_shape(problem_.horizon));
  add_second_places(out.objective, out.entries);
  if (kind == solvers::HessianKind::kExact) {
    int first = 0;
    for (const ConstraintPointer& term : problem_.constraints) {
      for (SecondPlace place : term->second_places()) {
        place.row += first;
        out.own.push_back(place);
      }
      first += static_cast<int>(term->rows().size());
    }
    add_second_places(out.own, out.entries);
    const DesignMap& map = *problem_.map;
    if (map.variables().size() > 0) {  // throws if there is none
      static_cast<void>(
          map.hessian(map.variables().start, Eigen::VectorXd::Zero(map.parameter_count())));
    }
  }
  if (problem_.design_weight > 0.0) {
    for (Eigen::Index i = 0; i < head_.design_count(); ++i) {
      out.entries.add(i, i);
    }
  }
  if (kind == solvers::HessianKind::kExact) {
    add_curvature(out.entries);
  }
  out.entries.finish();
  return out;
}

void Transcription::begin_values(HessianPlan& plan, const TrajectoryValues& values, double sigma,
                                 const Eigen::VectorXd& lambda, Eigen::VectorXd& out) {
  plan.entries.begin(out);
  put_second_partials(plan.objective, sigma * problem_.objective.second_partials(values),
                      plan.entries);
  if (!plan.own.empty()) {
    put_second_partials(plan.own, own_second_partials(values, lambda), plan.entries);
  }
  if (problem_.design_weight > 0.0) {
    for (Eigen::Index i = 0; i < head_.design_count(); ++i) {
      plan.entries.put(sigma * head_.design_cost_curvature(i));
    }
  }
}

void Transcription::add_second_places(const std::vector<SecondPlace>& places,
                                      EntryPlan& entries) const {
  for (const SecondPlace& place : places) {
    const std::vector<Eigen::Index> a = columns_of(place.a);
    const std::vector<Eigen::Index> b = columns_of(place.b);
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t j = place.a == place.b ? i : 0; j < b.size(); ++j) {
        entries.add_lower(a[i], b[j]);
      }
    }
  }
}

void Transcription::put_second_partials(const std::vector<SecondPlace>& places,
                                        const Eigen::VectorXd& second, EntryPlan& entries) {
  std::vector<double> a;
  std::vector<double> b;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double factor = second[static_cast<Eigen::Index>(k)];
    derivatives_of(places[k].a, a);
    if (places[k].a == places[k].b) {
      for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = i; j < a.size(); ++j) {
          entries.put(factor * a[i] * a[j]);
        }
      }
      continue;
    }
    derivatives_of(places[k].b, b);
    const std::vector<Eigen::Index> columns_a = columns_of(places[k].a);
    const std::vector<Eigen::Index> columns_b = columns_of(places[k].b);
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t j = 0; j < b.size(); ++j) {
        const double twice = columns_a[i] == columns_b[j] ? 2.0 : 1.0;
        entries.put(twice * factor * a[i] * b[j]);
      }
    }
  }
}

Eigen::VectorXd Transcription::own_second_partials(const TrajectoryValues& values,
                                                   const Eigen::VectorXd& lambda) const {
  std::vector<double> out;
  Eigen::Index first = 0;
  for (const ConstraintPointer& term : problem_.constraints) {
    const std::vector<SecondPlace> places = term->second_places();
    Eigen::VectorXd second(static_cast<Eigen::Index>(places.size()));
    term->second_partials(values, second);
    for (std::size_t i = 0; i < places.size(); ++i) {
      out.push_back(lambda[first + places[i].row] * second[static_cast<Eigen::Index>(i)]);
    }
    first += term->rows().size();
  }
  return Eigen::Map<const Eigen::VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()));
}

}  // namespace hbar
