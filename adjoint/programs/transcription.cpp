#include "hbar/adjoint/programs/transcription.h"

#include "hbar/adjoint/terms/value_access.h"
#include "hbar/core/base/error.h"

namespace hbar {
Transcription::Transcription(const TrajectoryProblem& problem)
    : problem_(problem), head_(problem_), variables_(head_.variables()) {
  std::vector<double> lower;
  std::vector<double> upper;
  for (const ConstraintPointer& term : problem_.constraints) {
    head_.require_places(*term);
    const ConstraintRows& rows = term->rows();
    lower.insert(lower.end(), rows.lower.begin(), rows.lower.end());
    upper.insert(upper.end(), rows.upper.begin(), rows.upper.end());
    limits_.names.insert(limits_.names.end(), rows.names.begin(), rows.names.end());
    own_rows_ += rows.size();
  }
  limits_.lower = Eigen::Map<const Eigen::VectorXd>(lower.data(), own_rows_);
  limits_.upper = Eigen::Map<const Eigen::VectorXd>(upper.data(), own_rows_);
}

void Transcription::require_multipliers(const Eigen::VectorXd& lambda) const {
  const Eigen::Index count = constraint_limits().lower.size();
  if (lambda.size() != count) {
    throw InvalidInput(concat("transcription: ", lambda.size(), " multipliers; the program has ",
                              count, " constraints"));
  }
}

void Transcription::require_size(const Eigen::VectorXd& x) const {
  if (x.size() != variables_.start.size()) {
    throw InvalidInput(concat("transcription: x has ", x.size(), " entries; it must have ",
                              variables_.start.size()));
  }
}

void Transcription::add_variables(const solvers::NlpVariables& more) {
  const auto join = [](Eigen::VectorXd& all, const Eigen::VectorXd& tail) {
    all.conservativeResize(all.size() + tail.size());
    all.tail(tail.size()) = tail;
  };
  join(variables_.start, more.start);
  join(variables_.lower, more.lower);
  join(variables_.upper, more.upper);
  join(variables_.scale, more.scale);
  variables_.names.insert(variables_.names.end(), more.names.begin(), more.names.end());
}

void Transcription::add_equations(const std::vector<std::string>& names) {
  const auto more = static_cast<Eigen::Index>(names.size());
  for (Eigen::VectorXd* bound : {&limits_.lower, &limits_.upper}) {
    bound->conservativeResize(bound->size() + more);
    bound->tail(more).setZero();
  }
  limits_.names.insert(limits_.names.end(), names.begin(), names.end());
}

void Transcription::own_constraints(const TrajectoryValues& values, Eigen::VectorXd& c) const {
  Eigen::Index first = 0;
  for (const ConstraintPointer& term : problem_.constraints) {
    term->values(values, c.segment(first, term->rows().size()));
    first += term->rows().size();
  }
}

TrajectoryPartials Transcription::lagrangian_partials(const TrajectoryValues& values, double sigma,
                                                      const Eigen::VectorXd& lambda) const {
  TrajectoryPartials out = problem_.objective.partials(values);
  for (Eigen::MatrixXd* field : {&out.q, &out.qdot, &out.measured, &out.u}) {
    *field *= sigma;
  }
  out.p *= sigma;
  Eigen::Index first = 0;
  for (const ConstraintPointer& term : problem_.constraints) {
    const std::vector<PartialPlace>& places = term->places();
    Eigen::VectorXd partials(static_cast<Eigen::Index>(places.size()));
    term->partials(values, partials);
    for (std::size_t i = 0; i < places.size(); ++i) {
      partial_at(out, places[i].place()) +=
          lambda[first + places[i].row] * partials[static_cast<Eigen::Index>(i)];
    }
    first += term->rows().size();
  }
  return out;
}

void Transcription::add_own_rows(EntryPlan& entries) const {
  Eigen::Index first = 0;
  for (const ConstraintPointer& term : problem_.constraints) {
    for (const PartialPlace& place : term->places()) {
      for (const Eigen::Index column : columns_of(place.place())) {
        entries.add(first + place.row, column);
      }
    }
    first += term->rows().size();
  }
}

void Transcription::put_own_rows(const TrajectoryValues& values, EntryPlan& entries) {
  std::vector<double> derivatives;
  for (const ConstraintPointer& term : problem_.constraints) {
    const std::vector<PartialPlace>& places = term->places();
    Eigen::VectorXd partials(static_cast<Eigen::Index>(places.size()));
    term->partials(values, partials);
    for (std::size_t i = 0; i < places.size(); ++i) {
      derivatives_of(places[i].place(), derivatives);
      for (const double derivative : derivatives) {
        entries.put(partials[static_cast<Eigen::Index>(i)] * derivative);
      }
    }
  }
}

}  // namespace hbar
