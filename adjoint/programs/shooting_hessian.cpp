// The Hessian of the Lagrangian of Shooting.
#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "hbar/adjoint/programs/shooting.h"
#include "hbar/adjoint/programs/stopwatch.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

bool is_input(const ValuePlace& place) {
  return place.field == ValueField::kU || place.field == ValueField::kP;
}

/// Whether a pair is summed in a dense block of two segments.
bool is_dense(const SecondPlace& place) { return !is_input(place.a) && !is_input(place.b); }

/// The pairs (places in a list) of each block, by its two segments.
using Blocks = std::map<std::pair<int, int>, std::vector<std::size_t>>;

template <typename IndexOf>
Blocks blocks_of(const std::vector<SecondPlace>& places, const IndexOf& segment_of) {
  Blocks out;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (is_dense(places[i])) {
      const int a = segment_of(places[i].a);
      const int b = segment_of(places[i].b);
      out[{std::min(a, b), std::max(a, b)}].push_back(i);
    }
  }
  return out;
}

std::vector<SecondPlace> sparse_ones(const std::vector<SecondPlace>& places) {
  std::vector<SecondPlace> out;
  std::copy_if(places.begin(), places.end(), std::back_inserter(out),
               [](const SecondPlace& place) { return !is_dense(place); });
  return out;
}

}  // namespace

int Shooting::segment_index(const ValuePlace& place) const {
  const ShootingSegment* segment = &segment_of(place.step);
  const auto at = std::find_if(segments_.begin(), segments_.end(),
                               [&](const auto& each) { return each.get() == segment; });
  return static_cast<int>(at - segments_.begin());
}

void Shooting::add_second_places(const std::vector<SecondPlace>& places, EntryPlan& entries) const {
  Transcription::add_second_places(sparse_ones(places), entries);
  const auto index = [this](const ValuePlace& place) { return segment_index(place); };
  for (const auto& [block, pairs] : blocks_of(places, index)) {
    const SegmentColumns& a = segments_[static_cast<std::size_t>(block.first)]->columns();
    const SegmentColumns& b = segments_[static_cast<std::size_t>(block.second)]->columns();
    const bool same = block.first == block.second;
    for (Eigen::Index j = 0; j < b.size(); ++j) {
      for (Eigen::Index i = same ? j : 0; i < a.size(); ++i) {
        entries.add_lower(a.place(i), b.place(j));
      }
    }
  }
}

void Shooting::put_second_partials(const std::vector<SecondPlace>& places,
                                   const Eigen::VectorXd& second, EntryPlan& entries) {
  std::vector<double> sparse;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!is_dense(places[i])) {
      sparse.push_back(second[static_cast<Eigen::Index>(i)]);
    }
  }
  Transcription::put_second_partials(
      sparse_ones(places),
      Eigen::Map<const Eigen::VectorXd>(sparse.data(), static_cast<Eigen::Index>(sparse.size())),
      entries);
  const auto index = [this](const ValuePlace& place) { return segment_index(place); };
  for (const auto& [block, pairs] : blocks_of(places, index)) {
    const SegmentColumns& a = segments_[static_cast<std::size_t>(block.first)]->columns();
    const SegmentColumns& b = segments_[static_cast<std::size_t>(block.second)]->columns();
    const bool same = block.first == block.second;
    const auto count = static_cast<Eigen::Index>(pairs.size());
    Eigen::MatrixXd by_a(count, a.size());
    Eigen::MatrixXd by_b(count, b.size());
    for (Eigen::Index k = 0; k < count; ++k) {
      const SecondPlace& place = places[pairs[static_cast<std::size_t>(k)]];
      const bool in_order = segment_index(place.a) == block.first;
      // Within one segment a pair of two numbers stands for (b, a) as well; its matrix is made
      // symmetric below, so that a number with itself counts half.
      const double half = same && place.a == place.b ? 0.5 : 1.0;
      const auto at = static_cast<Eigen::Index>(pairs[static_cast<std::size_t>(k)]);
      by_a.row(k) = half * second[at] * tangent_of(in_order ? place.a : place.b);
      by_b.row(k) = tangent_of(in_order ? place.b : place.a);
    }
    const Eigen::MatrixXd product = by_a.transpose() * by_b;
    for (Eigen::Index j = 0; j < b.size(); ++j) {
      for (Eigen::Index i = same ? j : 0; i < a.size(); ++i) {
        if (same) {
          entries.put(product(i, j) + product(j, i));
        } else {
          entries.put((a.place(i) == b.place(j) ? 2.0 : 1.0) * product(i, j));
        }
      }
    }
  }
}

void Shooting::add_curvature(EntryPlan& entries) const {
  for (const auto& segment : segments_) {
    const SegmentColumns& columns = segment->columns();
    for (Eigen::Index j = 0; j < columns.size(); ++j) {
      for (Eigen::Index i = j; i < columns.size(); ++i) {
        entries.add_lower(columns.place(i), columns.place(j));
      }
    }
  }
}

/// The curvature in x of the numbers that the terms read: per segment, weighted by the terms'
/// partials and the multipliers of continuity.
void Shooting::put_curvature(double sigma, const Eigen::VectorXd& lambda, EntryPlan& entries) {
  const TrajectoryPartials partials = lagrangian_partials(values_, sigma, lambda);
  std::vector<Eigen::MatrixXd> curvatures(segments_.size());
  std::vector<Eigen::VectorXd> by_p(segments_.size());
  std::vector<TrajectoryPartials> shares;
  Eigen::Index first = own_rows();
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    shares.push_back(share_of(*segments_[i], partials));
    if (i + 1 < segments_.size()) {
      const Eigen::Index dof = shares[i].q.rows();
      shares[i].q.rightCols<1>() += lambda.segment(first, dof);
      shares[i].qdot.rightCols<1>() += lambda.segment(first + dof, dof);
      first += 2 * dof;
    }
  }
  for_each_segment([&](std::size_t i) {
    curvatures[i] = segments_[i]->curvature(shares[i], map_jacobian_, by_p[i]);
  });
  for (std::size_t i = 1; i < segments_.size(); ++i) {
    by_p[0] += by_p[i];
  }
  const Eigen::Index designs = head_.design_count();
  if (designs > 0) {
    curvatures[0].topLeftCorner(designs, designs) += problem_.map->hessian(design(x_), by_p[0]);
  }
  for (const Eigen::MatrixXd& curvature : curvatures) {
    for (Eigen::Index j = 0; j < curvature.cols(); ++j) {
      for (Eigen::Index i = j; i < curvature.rows(); ++i) {
        entries.put(curvature(i, j));
      }
    }
  }
}

void Shooting::lagrangian_hessian(const Eigen::VectorXd& x, double sigma,
                                  const Eigen::VectorXd& lambda, solvers::HessianKind kind,
                                  Eigen::VectorXd& values) {
  require_multipliers(lambda);
  const Stopwatch stopwatch(times_.hessian);
  ++times_.hessians;
  HessianPlan& at = plan(kind);
  differentiate(x);
  begin_values(at, values_, sigma, lambda, values);
  if (kind == solvers::HessianKind::kExact) {
    try {
      put_curvature(sigma, lambda, at.entries);
    } catch (const NumericalFailure& error) {
      throw solvers::EvaluationError(error.what());
    }
  }
}

}  // namespace hbar
