#include "finger.h"

#include <cmath>
#include <limits>
#include <utility>

#include "hbar/core/error.h"

namespace hbar::finger_reach {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 3> kNames = {
    {{"proximal", "middle_hinge"}, {"middle", "distal_hinge"}, {"distal", "tip"}}};

std::string joint_x(const Phalanx& phalanx) {
  return "joint." + phalanx.next_joint + ".translation.x";
}
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

ParameterSet finger_parameters(const Model& model) {
  std::vector<std::string> names;
  for (const Phalanx& phalanx : phalanges(model)) {
    names.push_back(joint_x(phalanx));
    names.push_back(body_parameter(phalanx, "translation.x"));
    names.push_back(body_parameter(phalanx, "mass"));
    names.push_back(body_parameter(phalanx, "inertia"));
  }
  return ParameterSet::named(model, names);
}

FingerMap::FingerMap(const std::array<Phalanx, 3>& phalanges, const ParameterSet& set)
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
  return p;
}

Eigen::MatrixXd FingerMap::jacobian(const Eigen::VectorXd& d) const {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(count_, 6);
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

ConstraintPointer slenderness(const std::array<Phalanx, 3>& phalanges, const ParameterSet& set,
                              double ratio) {
  // Row: ratio · width / length ≥ 1, from mass and length; two places each.
  ConstraintRows rows{{},
                      Eigen::VectorXd::Ones(3),
                      Eigen::VectorXd::Constant(3, std::numeric_limits<double>::infinity())};
  std::vector<PartialPlace> places;
  for (int i = 0; i < 3; ++i) {
    const Phalanx& phalanx = phalanges[static_cast<std::size_t>(i)];
    rows.names.push_back("thickness." + phalanx.body);
    places.push_back({i, PartialPlace::Field::kP, 0, set.find(body_parameter(phalanx, "mass"))});
    places.push_back({i, PartialPlace::Field::kP, 0, set.find(joint_x(phalanx))});
  }
  struct Row {
    double mass;
    double length;
    double value;
  };
  const auto row = [=](const TrajectoryValues& values, Eigen::Index i) {
    const auto k = static_cast<std::size_t>(i);
    const double mass = values.p[places[2 * k].index];
    const double length = phalanges[k].length + values.p[places[2 * k + 1].index];
    return Row{mass, length,
               ratio * std::sqrt(mass / (phalanges[k].density * length * length * length))};
  };
  return user_constraint(
      rows, places,
      [row](const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> c) {
        for (Eigen::Index i = 0; i < 3; ++i) {
          c[i] = row(values, i).value;
        }
      },
      [row](const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> partials) {
        for (Eigen::Index i = 0; i < 3; ++i) {
          const Row at = row(values, i);
          partials[2 * i] = 0.5 * at.value / at.mass;
          partials[2 * i + 1] = -1.5 * at.value / at.length;
        }
      });
}

}  // namespace hbar::finger_reach
