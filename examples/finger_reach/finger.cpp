#include "finger.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

FingerMap::FingerMap(const std::array<Phalanx, 3>& phalanges, const ParameterSet& set,
                     double payload)
    : phalanges_(phalanges), count_(set.size()) {
  variables_.start.resize(6);
  variables_.scale.resize(6);
  for (std::size_t i = 0; i < 3; ++i) {
    const Phalanx& phalanx = phalanges_[i];
    places_[i] = {set.find(joint_x(phalanx)), set.find(body_parameter(phalanx, "translation.x")),
                  set.find(body_parameter(phalanx, "mass")),
                  set.find(body_parameter(phalanx, "inertia.x"))};
    const auto k = static_cast<Eigen::Index>(i);
    variables_.start[k] = phalanx.length;
    variables_.start[3 + k] = phalanx.width;
    variables_.scale[k] = 0.5 * phalanx.length;
    variables_.scale[3 + k] = 0.5 * phalanx.width;
    variables_.names.push_back("length." + phalanx.body);
  }
  for (const Phalanx& phalanx : phalanges_) {
    variables_.names.push_back("width." + phalanx.body);
  }
  variables_.units.assign(6, "m");
  variables_.lower = 0.5 * variables_.start;
  variables_.upper = 1.5 * variables_.start;
  add_payload(set, payload);
}

void FingerMap::add_payload(const ParameterSet& set, double payload) {
  const std::vector<Parameter>& all = set.parameters();
  const auto tip =
      std::find_if(all.begin(), all.end(), [](const Parameter& p) { return p.name == kTipMass; });
  if (tip == all.end()) {
    return;
  }
  tip_ = static_cast<int>(tip - all.begin());
  tip_mass_ = tip->nominal;
  for (Eigen::VectorXd* numbers : {&variables_.start, &variables_.lower, &variables_.upper}) {
    numbers->conservativeResize(7);
    (*numbers)[6] = payload;
  }
  variables_.scale.conservativeResize(7);
  variables_.scale[6] = tip_mass_;
  variables_.names.emplace_back("payload");
  variables_.units.emplace_back("kg");
}

Eigen::VectorXd FingerMap::parameters(const Eigen::VectorXd& d) const {
  Eigen::VectorXd p(count_);
  for (std::size_t i = 0; i < 3; ++i) {
    const Phalanx& phalanx = phalanges_[i];
    const Places& place = places_[i];
    const double l = d[static_cast<Eigen::Index>(i)];
    const double w = d[static_cast<Eigen::Index>(i) + 3];
    const double m = phalanx.density * l * w * w;
    const double across = m * (l * l + w * w) / 12.0;
    p[place.joint_x] = l - phalanx.length;
    p[place.body_x] = 0.5 * (l - phalanx.length);
    p[place.mass] = m;
    p.segment<3>(place.inertia) << m * w * w / 6.0, across, across;
  }
  if (tip_ >= 0) {
    p[tip_] = tip_mass_ + d[6];
  }
  return p;
}

Eigen::MatrixXd FingerMap::jacobian(const Eigen::VectorXd& d) const {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(count_, d.size());
  if (tip_ >= 0) {
    J(tip_, 6) = 1.0;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Places& place = places_[i];
    const auto by_l = static_cast<Eigen::Index>(i);
    const Eigen::Index by_w = by_l + 3;
    const double l = d[by_l];
    const double w = d[by_w];
    const double rho = phalanges_[i].density;
    J(place.joint_x, by_l) = 1.0;
    J(place.body_x, by_l) = 0.5;
    J(place.mass, by_l) = rho * w * w;
    J(place.mass, by_w) = 2.0 * rho * l * w;
    // I_x = ρ l w⁴ / 6, I_y = I_z = ρ (l³ w² + l w⁴) / 12
    J(place.inertia, by_l) = rho * w * w * w * w / 6.0;
    J(place.inertia, by_w) = rho * l * w * w * w * 4.0 / 6.0;
    for (int k = 1; k < 3; ++k) {
      J(place.inertia + k, by_l) = rho * w * w * (3.0 * l * l + w * w) / 12.0;
      J(place.inertia + k, by_w) = rho * l * w * (2.0 * l * l + 4.0 * w * w) / 12.0;
    }
  }
  return J;
}

Eigen::MatrixXd FingerMap::hessian(const Eigen::VectorXd& d, const Eigen::VectorXd& y) const {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(d.size(), d.size());
  for (std::size_t i = 0; i < 3; ++i) {
    const Places& place = places_[i];
    const auto by_l = static_cast<Eigen::Index>(i);
    const Eigen::Index by_w = by_l + 3;
    const double l = d[by_l];
    const double w = d[by_w];
    const double along = y[place.inertia] / 6.0;
    const double across = (y[place.inertia + 1] + y[place.inertia + 2]) / 12.0;
    // m = ρ l w², I_x = ρ l w⁴ / 6, I_y = I_z = ρ (l³ w² + l w⁴) / 12
    const double ll = across * 6.0 * l * w * w;
    const double lw = y[place.mass] * 2.0 * w + along * 4.0 * w * w * w +
                      across * (6.0 * l * l * w + 4.0 * w * w * w);
    const double ww = y[place.mass] * 2.0 * l + along * 12.0 * l * w * w +
                      across * (2.0 * l * l * l + 12.0 * l * w * w);
    const double rho = phalanges_[i].density;
    H(by_l, by_l) = rho * ll;
    H(by_l, by_w) = rho * lw;
    H(by_w, by_l) = rho * lw;
    H(by_w, by_w) = rho * ww;
  }
  return H;
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
