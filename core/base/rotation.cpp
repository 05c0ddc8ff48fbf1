#include "hbar/core/base/rotation.h"

#include <array>

#include "hbar/core/base/stumpff.h"

namespace hbar {

template <Scalar S>
Matrix3<S> exp_rotation(const Vector3<S>& r) {
  const S s = r.dot(r);
  const auto c = stumpff(s);
  // R = c0 I + c1 [r] + c2 r rᵀ.
  Matrix3<S> R = c[2] * r * r.transpose();
  R.diagonal().array() += c[0];
  R += c[1] * skew(r);
  return R;
}

template <Scalar S>
Matrix3<S> axis_rotation(const Eigen::Vector3d& axis, const S& angle) {
  using std::cos;
  using std::sin;
  const S c = cos(angle);
  const S s = sin(angle);
  const S t = S(1.0) - c;
  const double x = axis.x();
  const double y = axis.y();
  const double z = axis.z();
  Matrix3<S> R;
  R << c + t * (x * x), t * (x * y) - s * z, t * (x * z) + s * y,  //
      t * (x * y) + s * z, c + t * (y * y), t * (y * z) - s * x,   //
      t * (x * z) - s * y, t * (y * z) + s * x, c + t * (z * z);
  return R;
}

template <Scalar S>
Matrix3<S> right_jacobian(const Vector3<S>& r) {
  const S s = r.dot(r);
  const auto c = stumpff(s);
  // J_r = I − c2 [r] + c3 [r]², and [r]² = r rᵀ − s I.
  Matrix3<S> J = c[3] * r * r.transpose() - c[2] * skew(r);
  J.diagonal().array() += S(1.0) - c[3] * s;
  return J;
}

template <Scalar S>
Matrix3<S> right_jacobian_inverse(const Vector3<S>& r) {
  const S s = r.dot(r);
  const auto c = stumpff(s);
  // J_r⁻¹ = I + [r] / 2 + e [r]² with e = (1 − c1 / (2 c2)) / s, where 2 c2 − c1 = s (c3 − 2 c4).
  const S e = (c[3] - 2.0 * c[4]) / (2.0 * c[2]);
  Matrix3<S> J = e * r * r.transpose() + 0.5 * skew(r);
  J.diagonal().array() += S(1.0) - e * s;
  return J;
}

namespace {

/// Coefficients of J_r x = x − b r × x + g r × (r × x) and their derivatives with respect to s =
/// ‖r‖².
template <Scalar S>
struct RightJacobianCoefficients {
  S b, b1, b2, g, g1, g2;
};

template <Scalar S>
RightJacobianCoefficients<S> right_jacobian_coefficients(const S& s) {
  const auto c = stumpff(s);
  // dc_n/ds = (n c_{n+2} − c_{n+1}) / 2.
  const S d3 = 0.5 * (3.0 * c[5] - c[4]);
  const S d4 = 0.5 * (4.0 * c[6] - c[5]);
  const S d5 = 0.5 * (5.0 * c[7] - c[6]);
  return {c[2], 0.5 * (2.0 * c[4] - c[3]), 0.5 * (2.0 * d4 - d3), c[3], d3, 0.5 * (3.0 * d5 - d4)};
}

/// T[x, y]: derivative of J_r(r) x along y.
template <Scalar S>
Vector3<S> first_derivative(const RightJacobianCoefficients<S>& k, const Vector3<S>& r,
                            const Vector3<S>& x, const Vector3<S>& y) {
  const Vector3<S> rx = r.cross(x);
  const S sy = 2.0 * r.dot(y);
  return -k.b * y.cross(x) - (k.b1 * sy) * rx + k.g * (y.cross(rx) + r.cross(y.cross(x))) +
         (k.g1 * sy) * r.cross(rx);
}

/// Derivative of T[x, y] along z.
template <Scalar S>
Vector3<S> second_derivative(const RightJacobianCoefficients<S>& k, const Vector3<S>& r,
                             const Vector3<S>& x, const Vector3<S>& y, const Vector3<S>& z) {
  const Vector3<S> rx = r.cross(x);
  const Vector3<S> yx = y.cross(x);
  const Vector3<S> zx = z.cross(x);
  const S sy = 2.0 * r.dot(y);
  const S sz = 2.0 * r.dot(z);
  const S syz = 2.0 * y.dot(z);
  const Vector3<S> double_y = y.cross(rx) + r.cross(yx);
  const Vector3<S> double_z = z.cross(rx) + r.cross(zx);
  return -(k.b1 * sz) * yx - (k.b2 * sz * sy + k.b1 * syz) * rx - (k.b1 * sy) * zx +
         (k.g1 * sz) * double_y + k.g * (y.cross(zx) + z.cross(yx)) +
         (k.g2 * sz * sy + k.g1 * syz) * r.cross(rx) + (k.g1 * sy) * double_z;
}

}  // namespace

template <Scalar S>
ExponentialRates<S> exponential_rates(const Vector3<S>& r, const Vector3<S>& rate,
                                      const Vector3<S>& rate_dot) {
  const auto k = right_jacobian_coefficients<S>(r.dot(r));
  ExponentialRates<S> out;
  out.J = right_jacobian(r);
  out.J_dot_rate = first_derivative(k, r, rate, rate);
  for (int i = 0; i < 3; ++i) {
    const Vector3<S> e = Vector3<S>::Unit(i);
    out.d_velocity_dr.col(i) = first_derivative(k, r, rate, e);
    out.d_acceleration_dr.col(i) =
        first_derivative(k, r, rate_dot, e) + second_derivative(k, r, rate, rate, e);
    out.d_acceleration_drate.col(i) =
        first_derivative(k, r, e, rate) + first_derivative(k, r, rate, e);
    Matrix3<S>& dJ = out.dJ_dr[static_cast<std::size_t>(i)];
    for (int c = 0; c < 3; ++c) {
      dJ.col(c) = first_derivative<S>(k, r, Vector3<S>::Unit(c), e);
    }
  }
  return out;
}

Eigen::Vector3d log_rotation(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd rotation(R);
  return rotation.angle() * rotation.axis();
}

template <std::same_as<Dual> S>
Vector3<S> log_rotation(const Matrix3<S>& R) {
  const Eigen::Matrix3d value = R.unaryExpr([](const Dual& entry) { return entry.value; });
  const Eigen::Matrix3d slope = R.unaryExpr([](const Dual& entry) { return entry.slope; });
  const Eigen::Vector3d r = log_rotation(value);
  const Eigen::Matrix3d turn = value.transpose() * slope;
  const Eigen::Vector3d axis(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0),
                             turn(1, 0) - turn(0, 1));
  const Eigen::Vector3d rate = right_jacobian_inverse(r) * (0.5 * axis);
  return {Dual(r[0], rate[0]), Dual(r[1], rate[1]), Dual(r[2], rate[2])};
}

template Matrix3<double> exp_rotation(const Vector3<double>&);
template Matrix3<Dual> exp_rotation(const Vector3<Dual>&);
template Matrix3<double> axis_rotation(const Eigen::Vector3d&, const double&);
template Matrix3<Dual> axis_rotation(const Eigen::Vector3d&, const Dual&);
template Matrix3<double> right_jacobian(const Vector3<double>&);
template Matrix3<Dual> right_jacobian(const Vector3<Dual>&);
template Vector3<Dual> log_rotation(const Matrix3<Dual>&);
template Matrix3<double> right_jacobian_inverse(const Vector3<double>&);
template Matrix3<Dual> right_jacobian_inverse(const Vector3<Dual>&);
template ExponentialRates<double> exponential_rates(const Vector3<double>&, const Vector3<double>&,
                                                    const Vector3<double>&);
template ExponentialRates<Dual> exponential_rates(const Vector3<Dual>&, const Vector3<Dual>&,
                                                  const Vector3<Dual>&);

}  // namespace hbar
