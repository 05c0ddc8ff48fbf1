#include "leg_map.h"

#include "hbar/core/base/error.h"

namespace hbar::walker {
namespace {

constexpr std::array<const char*, 2> kSides = {"left_", "right_"};

double length_of(const Model& model, const std::string& body) {
  const auto* capsule = std::get_if<Capsule>(&model.link(model.find_body(body)).body.shape);
  if (capsule == nullptr) {
    throw InvalidInput(concat("walker: body '", body, "' must be a capsule"));
  }
  return capsule->length;
}

}  // namespace

const std::array<Segment, 2>& segments() {
  static const std::array<Segment, 2> all = {{{"thigh", "knee"}, {"shank", "foot"}}};
  return all;
}

ParameterSet leg_parameters(const Model& model) {
  std::vector<std::string> names;
  for (const std::string side : kSides) {
    for (const Segment& segment : segments()) {
      names.push_back("body." + side + segment.name + ".length");
      names.push_back("body." + side + segment.name + ".translation.y");
      names.push_back("joint." + side + segment.next_joint + ".translation.y");
    }
  }
  return ParameterSet::named(model, names);
}

LegMap::LegMap(const Model& model, const ParameterSet& set, double share)
    : nominal_(2), base_(set.nominal()), slope_(Eigen::MatrixXd::Zero(set.size(), 2)) {
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Segment& segment = segments()[static_cast<std::size_t>(i)];
    nominal_[i] = length_of(model, "left_" + segment.name);
    if (length_of(model, "right_" + segment.name) != nominal_[i]) {
      throw InvalidInput(concat("walker: both legs must have the same ", segment.name));
    }
    variables_.names.push_back("length of " + segment.name);
    variables_.units.emplace_back(length_unit(model.units()));
    for (const std::string side : kSides) {
      slope_(set.find("body." + side + segment.name + ".length"), i) = 1.0;
      slope_(set.find("body." + side + segment.name + ".translation.y"), i) = -0.5;
      slope_(set.find("joint." + side + segment.next_joint + ".translation.y"), i) = -1.0;
    }
  }
  variables_.start = nominal_;
  variables_.lower = (1.0 - share) * nominal_;
  variables_.upper = (1.0 + share) * nominal_;
  variables_.scale = 0.1 * nominal_;
}

void LegMap::begin_at(const Eigen::Vector2d& lengths) {
  const bool held = variables_.lower == variables_.upper;
  variables_.start = lengths;
  if (held) {
    variables_.lower = variables_.upper = lengths;
  }
}

}  // namespace hbar::walker
