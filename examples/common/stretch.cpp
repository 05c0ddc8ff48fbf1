#include "examples/common/stretch.h"

#include <utility>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/core/base/error.h"

namespace hbar::example {
namespace {

constexpr const char* kAxes[] = {".x", ".y", ".z"};

/// How the parameters of a segment follow its length.
std::vector<std::pair<std::string, double>> slopes_of(const Model& model, const Segment& segment) {
  const Eigen::Vector3d& middle = model.link(model.find_body(segment.body)).body.X_JB.p;
  Eigen::Index axis = 0;
  middle.cwiseAbs().maxCoeff(&axis);
  const double sign = middle[axis] < 0.0 ? -1.0 : 1.0;
  const std::string translation = std::string(".translation") + kAxes[axis];
  std::vector<std::pair<std::string, double>> out = {
      {"body." + segment.body + ".length", 1.0},
      {"body." + segment.body + translation, 0.5 * sign}};
  if (!segment.next_joint.empty()) {
    out.emplace_back("joint." + segment.next_joint + translation, sign);
  }
  return out;
}

double length_of(const Model& model, const FreeLength& length) {
  double out = 0.0;
  for (const Segment& segment : length.segments) {
    const auto* capsule =
        std::get_if<Capsule>(&model.link(model.find_body(segment.body)).body.shape);
    if (capsule == nullptr) {
      throw InvalidInput(concat("body '", segment.body, "' must be a capsule"));
    }
    if (out != 0.0 && out != capsule->length) {
      throw InvalidInput(concat(length.name, ": '", segment.body, "' is not as long as '",
                                length.segments.front().body, "'"));
    }
    out = capsule->length;
  }
  return out;
}

}  // namespace

std::vector<std::string> stretched_parameters(const Model& model,
                                              const std::vector<FreeLength>& lengths) {
  std::vector<std::string> names;
  for (const FreeLength& length : lengths) {
    for (const Segment& segment : length.segments) {
      for (const auto& [name, slope] : slopes_of(model, segment)) {
        names.push_back(name);
      }
    }
  }
  return names;
}

DesignMapPointer stretch_map(const Model& model, const ParameterSet& set,
                             const Eigen::VectorXd& base, const std::vector<FreeLength>& lengths,
                             double share, const Eigen::VectorXd& start) {
  const auto count = static_cast<Eigen::Index>(lengths.size());
  std::vector<DesignVariable> variables;
  Eigen::VectorXd nominal(count);
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(set.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const FreeLength& length = lengths[static_cast<std::size_t>(i)];
    nominal[i] = length_of(model, length);
    const double first = start.size() > 0 ? start[i] : nominal[i];
    const bool held = share == 0.0;
    variables.push_back({.name = length.name,
                         .unit = std::string(length_unit(model.units())),
                         .start = first,
                         .lower = held ? first : (1.0 - share) * nominal[i],
                         .upper = held ? first : (1.0 + share) * nominal[i],
                         .scale = length.scale});
    for (const Segment& segment : length.segments) {
      for (const auto& [name, slope] : slopes_of(model, segment)) {
        slopes(set.find(name), i) = slope;
      }
    }
  }
  return affine_map(design_variables(variables), base - slopes * nominal, slopes);
}

}  // namespace hbar::example
