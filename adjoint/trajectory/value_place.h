#pragma once

namespace hbar {

/// Members of TrajectoryValues whose numbers terms read.
enum class ValueField { kQ, kQdot, kMeasured, kU, kP };

/// One number of TrajectoryValues.
struct ValuePlace {
  ValueField field = ValueField::kQ;  ///< which member
  int step = 0;                       ///< column of the member; not read for kP
  int index = 0;                      ///< row of the member

  friend bool operator==(const ValuePlace&, const ValuePlace&) = default;
};

/// One number of TrajectoryValues that a row reads.
struct PartialPlace {
  using Field = ValueField;

  int row = 0;                        ///< of its term
  ValueField field = ValueField::kQ;  ///< which member
  int step = 0;                       ///< column of the member; not read for kP
  int index = 0;                      ///< row of the member

  [[nodiscard]] ValuePlace place() const { return {field, step, index}; }
};

/// Two numbers with respect to which a row has a second partial, ∂²c_row/∂a∂b. A pair is listed
/// once, in either order, and stands for (b, a) as well.
struct SecondPlace {
  int row = 0;  ///< of its term
  ValuePlace a;
  ValuePlace b;
};

}  // namespace hbar
