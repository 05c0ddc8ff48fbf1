#include "finger.h"

#include <limits>
#include <utility>

#include "hbar/adjoint/design/formula_map.h"
#include "hbar/adjoint/terms/generic_terms.h"
#include "hbar/core/base/error.h"

namespace hbar::finger_reach {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 3> kNames = {
    {{"proximal", "middle_hinge"}, {"middle", "distal_hinge"}, {"distal", "tip"}}};

std::string joint_x(const Phalanx& phalanx) {
  return "joint." + phalanx.next_joint + ".translation.x";
}
constexpr const char* kTipMass = "body.tip.mass";

std::string body_parameter(const Phalanx& phalanx, const char* what) {
  return "body." + phalanx.body + "." + what;
}

}  // namespace

std::array<Phalanx, 3> phalanges(const Model& model) {
  std::array<Phalanx, 3> out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [name, next] = kNames[i];
    const Body& body = model.link(model.find_body(name)).body;
    const Joint& joint = model.link(model.find_joint(next)).joint;
    const auto* shape = std::get_if<Cuboid>(&body.shape);
    if (shape == nullptr || shape->size[1] != shape->size[2] ||
        !body.X_JB.p.isApprox(Eigen::Vector3d(0.5 * shape->size[0], 0.0, 0.0)) ||
        !joint.X_PJ.p.isApprox(Eigen::Vector3d(shape->size[0], 0.0, 0.0))) {
      throw InvalidInput(concat("finger: body '", name,
                                "' must be a cuboid of size \"l w w\" at \"l/2 0 0\", and joint '",
                                next, "' must be at \"l 0 0\""));
    }
    out[i] = {name, next, shape->size[0], shape->size[1], body.mass / shape->size.prod()};
  }
  return out;
}

ParameterSet finger_parameters(const Model& model, bool payload) {
  std::vector<std::string> names;
  for (const Phalanx& phalanx : phalanges(model)) {
    names.push_back(joint_x(phalanx));
    names.push_back(body_parameter(phalanx, "translation.x"));
    names.push_back(body_parameter(phalanx, "mass"));
    names.push_back(body_parameter(phalanx, "inertia"));
  }
  if (payload) {
    names.emplace_back(kTipMass);
  }
  return ParameterSet::named(model, names);
}

DesignMapPointer finger_map(const std::array<Phalanx, 3>& phalanges, const ParameterSet& set,
                            std::optional<double> payload) {
  std::vector<DesignVariable> variables;
  const auto add = [&](const std::string& name, double start) {
    variables.push_back({name, "m", start, 0.5 * start, 1.5 * start, 0.5 * start});
  };
  for (const Phalanx& phalanx : phalanges) {
    add("length." + phalanx.body, phalanx.length);
  }
  for (const Phalanx& phalanx : phalanges) {
    add("width." + phalanx.body, phalanx.width);
  }
  const double tip_mass = payload ? set.nominal()[set.find(kTipMass)] : 0.0;
  if (payload) {
    variables.push_back({"payload", "kg", *payload, *payload, *payload, tip_mass});
  }
  return formula_map(set, design_variables(variables), [=](auto d, auto& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Phalanx& phalanx = phalanges[i];
      const auto l = d[i];
      const auto w = d[i + 3];
      const auto m = phalanx.density * l * w * w;
      p[joint_x(phalanx)] = l - phalanx.length;
      p[body_parameter(phalanx, "translation.x")] = 0.5 * (l - phalanx.length);
      p[body_parameter(phalanx, "mass")] = m;
      p[body_parameter(phalanx, "inertia.x")] = m * w * w / 6.0;
      p[body_parameter(phalanx, "inertia.y")] = m * (l * l + w * w) / 12.0;
      p[body_parameter(phalanx, "inertia.z")] = m * (l * l + w * w) / 12.0;
    }
    if (payload) {
      p[kTipMass] = tip_mass + d[6];
    }
  });
}

ConstraintPointer slenderness(const std::array<Phalanx, 3>& phalanges, const ParameterSet& set,
                              double ratio) {
  // Row: ratio · width / length ≥ 1, from mass and length; two places each.
  std::vector<GenericRow> rows;
  for (const Phalanx& phalanx : phalanges) {
    const double nominal = phalanx.length;
    const double density = phalanx.density;
    rows.push_back({.name = "thickness." + phalanx.body,
                    .lower = 1.0,
                    .upper = std::numeric_limits<double>::infinity(),
                    .places = {{ValueField::kP, 0, set.find(body_parameter(phalanx, "mass"))},
                               {ValueField::kP, 0, set.find(joint_x(phalanx))}},
                    .f = [=](auto x) {
                      using std::sqrt;
                      const auto length = nominal + x[1];
                      return ratio * sqrt(x[0] / (density * length * length * length));
                    }});
  }
  return generic_constraint(std::move(rows));
}

}  // namespace hbar::finger_reach
