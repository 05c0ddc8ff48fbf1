#include "hbar/adjoint/terms/value_access.h"

#include <array>
#include <type_traits>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

constexpr std::array kEveryField = {ValueField::kQ, ValueField::kQdot, ValueField::kMeasured,
                                    ValueField::kU, ValueField::kP};

/// A member's numbers, column by column.
template <typename Number>
struct MemberView {
  Number* data;
  Eigen::Index rows;
  Eigen::Index columns;
};

/// The member of TrajectoryValues or TrajectoryPartials; p is one column.
template <typename Members>
auto member_of(Members& members, ValueField field) {
  using Number = std::conditional_t<std::is_const_v<Members>, const double, double>;
  const auto view = [](auto& m) { return MemberView<Number>{m.data(), m.rows(), m.cols()}; };
  switch (field) {
    case ValueField::kQ:
      return view(members.q);
    case ValueField::kQdot:
      return view(members.qdot);
    case ValueField::kMeasured:
      return view(members.measured);
    case ValueField::kU:
      return view(members.u);
    case ValueField::kP:
      break;
  }
  return view(members.p);
}

template <typename Members>
auto& number_in(Members& members, const ValuePlace& place) {
  const auto member = member_of(members, place.field);
  const int column = place.field == ValueField::kP ? 0 : place.step;
  if (place.index < 0 || place.index >= member.rows || column < 0 || column >= member.columns) {
    throw InvalidInput(concat("there is no ", place_name(place), ": ", field_name(place.field),
                              " is ", member.rows, " x ", member.columns));
  }
  return member.data[column * member.rows + place.index];
}

}  // namespace

std::string_view field_name(ValueField field) {
  constexpr std::array<std::string_view, 5> kNames = {"q", "qdot", "measured", "u", "p"};
  return kNames[static_cast<std::size_t>(field)];
}

std::string place_name(const ValuePlace& place) {
  if (place.field == ValueField::kP) {
    return concat("p ", place.index);
  }
  return concat(field_name(place.field), ' ', place.index, " at step ", place.step);
}

Eigen::Index field_rows(const TrajectoryValues& values, ValueField field) {
  return member_of(values, field).rows;
}

Eigen::Index field_columns(const TrajectoryValues& values, ValueField field) {
  return member_of(values, field).columns;
}

double value_at(const TrajectoryValues& values, const ValuePlace& place) {
  return number_in(values, place);
}

double& value_at(TrajectoryValues& values, const ValuePlace& place) {
  return number_in(values, place);
}

double& partial_at(TrajectoryPartials& partials, const ValuePlace& place) {
  return number_in(partials, place);
}

std::vector<ValuePlace> all_places(const TrajectoryValues& shape) {
  std::vector<ValuePlace> out;
  for (const ValueField field : kEveryField) {
    const auto member = member_of(shape, field);
    for (int step = 0; step < member.columns; ++step) {
      for (int index = 0; index < member.rows; ++index) {
        out.push_back({field, step, index});
      }
    }
  }
  return out;
}

void add_second_order(const std::vector<SecondPlace>& places,
                      const Eigen::Ref<const Eigen::VectorXd>& second, const ValueTangent& tangent,
                      TrajectoryPartials& out) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const SecondPlace& at = places[i];
    const double value = second[static_cast<Eigen::Index>(i)];
    partial_at(out, at.a) += value * value_at(tangent, at.b);
    if (!(at.a == at.b)) {
      partial_at(out, at.b) += value * value_at(tangent, at.a);
    }
  }
}

}  // namespace hbar
