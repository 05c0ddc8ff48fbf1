#include "length_map.h"

#include "hbar/core/base/error.h"

namespace hbar::manipulation {
namespace {

constexpr const char* kAxes[] = {".x", ".y", ".z"};

/// Along which axis of its joint frame, and which way, a phalanx reaches.
struct Reach {
  Eigen::Index axis = 0;
  double sign = 1.0;
};

Reach reach_of(const Body& body) {
  Reach reach;
  body.X_JB.p.cwiseAbs().maxCoeff(&reach.axis);
  reach.sign = body.X_JB.p[reach.axis] < 0.0 ? -1.0 : 1.0;
  return reach;
}

std::string translation(const std::string& owner, const Reach& reach) {
  return owner + ".translation" + kAxes[reach.axis];
}

}  // namespace

ParameterSet length_parameters(const Model& model, const std::vector<Phalanx>& phalanges,
                               const std::vector<FixedParameter>& fixed) {
  std::vector<std::string> names;
  for (const Phalanx& phalanx : phalanges) {
    const Reach reach = reach_of(model.link(model.find_body(phalanx.body)).body);
    names.push_back("body." + phalanx.body + ".length");
    names.push_back(translation("body." + phalanx.body, reach));
    if (!phalanx.next_joint.empty()) {
      names.push_back(translation("joint." + phalanx.next_joint, reach));
    }
  }
  for (const FixedParameter& parameter : fixed) {
    names.push_back(parameter.name);
  }
  return ParameterSet::named(model, names);
}

LengthMap::LengthMap(const Model& model, const std::vector<Phalanx>& phalanges,
                     const std::vector<FixedParameter>& fixed, const ParameterSet& set,
                     double share)
    : base_(set.nominal()),
      slope_(Eigen::MatrixXd::Zero(set.size(), static_cast<Eigen::Index>(phalanges.size()))) {
  const Eigen::Index count = slope_.cols();
  variables_.start.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Phalanx& phalanx = phalanges[static_cast<std::size_t>(i)];
    const Body& body = model.link(model.find_body(phalanx.body)).body;
    const auto* capsule = std::get_if<Capsule>(&body.shape);
    if (capsule == nullptr) {
      throw InvalidInput(concat("body '", phalanx.body, "' must be a capsule"));
    }
    const Reach reach = reach_of(body);
    variables_.names.push_back("length of " + phalanx.body);
    variables_.units.emplace_back(length_unit(model.units()));
    variables_.start[i] = capsule->length;
    slope_(set.find("body." + phalanx.body + ".length"), i) = 1.0;
    slope_(set.find(translation("body." + phalanx.body, reach)), i) = 0.5 * reach.sign;
    if (!phalanx.next_joint.empty()) {
      slope_(set.find(translation("joint." + phalanx.next_joint, reach)), i) = reach.sign;
    }
  }
  nominal_ = variables_.start;
  variables_.lower = (1.0 - share) * variables_.start;
  variables_.upper = (1.0 + share) * variables_.start;
  variables_.scale = 0.5 * share * variables_.start;
  for (const FixedParameter& parameter : fixed) {
    base_[set.find(parameter.name)] = parameter.value;
  }
}

}  // namespace hbar::manipulation
