#include "hbar/contact/surface_distance.h"

#include <algorithm>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

/// Distance to a point (rank 3) or to a line along z (rank 2) minus a radius, at the offset y.
template <Scalar S>
SurfaceSample<S> round_sample(const Vector3<S>& y, const S& radius, int rank) {
  using std::sqrt;
  const S squared = y.squaredNorm();
  SurfaceSample<S> out;
  if (!(squared > 0.0)) {
    // At the centre all directions are equivalent: zero curvature is better than an infinite one.
    out.d = -radius;
    out.n = Vector3<S>::UnitX();
    out.gradient = out.n;
    out.dn_dx.setZero();
    return out;
  }
  const S length = sqrt(squared);
  out.d = length - radius;
  out.n = y / length;
  out.gradient = out.n;
  out.dn_dx = -out.n * out.n.transpose();
  for (int i = 0; i < rank; ++i) {
    out.dn_dx(i, i) += 1.0;
  }
  out.dn_dx /= length;
  return out;
}

template <Scalar S>
SurfaceSample<S> flat_sample(const S& d, const Vector3<S>& n) {
  return {d, n, n, Matrix3<S>::Zero()};
}

template <Scalar S>
Vector3<S> along_axis(int axis, const S& coordinate) {
  Vector3<S> n = Vector3<S>::Zero();
  n[axis] = S(coordinate < 0.0 ? -1.0 : 1.0);
  return n;
}

/// The face of a cuboid that x is nearest to from inside.
template <typename Vector>
int nearest_face(const Vector& x, const Eigen::Vector3d& sizes) {
  int face = 0;
  double best = std::abs(value_of(x[0])) - 0.5 * sizes[0];
  for (int i = 1; i < 3; ++i) {
    const double d = std::abs(value_of(x[i])) - 0.5 * sizes[i];
    if (d > best) {
      best = d;
      face = i;
    }
  }
  return face;
}

/// Distance of a body with faces |x_i| ≤ half_i, of which `offsets` are |x_i| − half_i: to the
/// nearest face inside and beside one, to the edge or corner beyond several.
template <Scalar S>
SurfaceSample<S> faceted_sample(const Vector3<S>& x, const Vector3<S>& sizes) {
  using std::abs;
  using std::sqrt;
  Vector3<S> beyond = Vector3<S>::Zero();
  int faces = 0;
  for (int i = 0; i < 3; ++i) {
    const S offset = abs(x[i]) - 0.5 * sizes[i];
    if (offset > 0.0) {
      beyond[i] = x[i] < 0.0 ? S(-offset) : offset;
      ++faces;
    }
  }
  if (faces < 2) {
    const int face = nearest_face(
        x, Eigen::Vector3d(sizes.unaryExpr([](const S& size) { return value_of(size); })));
    return flat_sample<S>(abs(x[face]) - 0.5 * sizes[face], along_axis<S>(face, x[face]));
  }
  SurfaceSample<S> out;
  out.d = sqrt(beyond.squaredNorm());
  out.n = beyond / out.d;
  out.gradient = out.n;
  out.dn_dx = -out.n * out.n.transpose();
  for (int i = 0; i < 3; ++i) {
    if (beyond[i] != 0.0) {
      out.dn_dx(i, i) += 1.0;
    }
  }
  out.dn_dx /= out.d;
  return out;
}

/// Offset from the nearest point of the segment of half-length `half` along z.
template <Scalar S>
Vector3<S> from_segment(const Vector3<S>& x, const S& half) {
  Vector3<S> y = x;
  if (x.z() > half) {
    y.z() -= half;
  } else if (x.z() < -half) {
    y.z() += half;
  } else {
    y.z() = S(0.0);
  }
  return y;
}

/// Distance to the rim where two faces at right angles meet, from beyond both.
template <Scalar S>
SurfaceSample<S> beyond_both(const SurfaceSample<S>& a, const SurfaceSample<S>& b) {
  using std::sqrt;
  SurfaceSample<S> out;
  out.d = sqrt(a.d * a.d + b.d * b.d);
  out.n = (a.d * a.n + b.d * b.n) / out.d;
  out.gradient = out.n;
  out.dn_dx = (a.n * a.n.transpose() + a.d * a.dn_dx + b.n * b.n.transpose() + b.d * b.dn_dx -
               out.n * out.n.transpose()) /
              out.d;
  return out;
}

/// Direction away from the z axis; zero on it.
template <Scalar S>
Vector3<S> radial(const Vector3<S>& x) {
  using std::sqrt;
  const S squared = x[0] * x[0] + x[1] * x[1];
  if (!(squared > 0.0)) {
    return Vector3<S>::UnitX();
  }
  return Vector3<S>(x[0], x[1], S(0.0)) / sqrt(squared);
}

/// Field values with the direction that a dual number carries.
SurfaceSample<double> field_sample(const DistanceField& field, const Eigen::Vector3d& x) {
  const DistanceField::Sample at = field.sample(x);
  SurfaceSample<double> out;
  const double length = at.gradient.norm();
  out.d = at.distance;
  out.gradient = at.gradient;
  if (length > 0.0) {
    out.n = at.gradient / length;
    out.dn_dx = (at.hessian - out.n * (out.n.transpose() * at.hessian)) / length;
  } else {
    out.n = Eigen::Vector3d::UnitX();
    out.dn_dx.setZero();
  }
  return out;
}

SurfaceSample<Dual> field_sample(const DistanceField& field, const Vector3<Dual>& x) {
  Eigen::Vector3d value;
  Eigen::Vector3d slope;
  for (int i = 0; i < 3; ++i) {
    value[i] = x[i].value;
    slope[i] = x[i].slope;
  }
  const DistanceField::Sample at = field.sample(value);
  const Eigen::Vector3d gradient_slope = at.hessian * slope;
  const Eigen::Matrix3d hessian_slope = field.hessian_slope(value, slope);
  SurfaceSample<Dual> out;
  out.d = {at.distance, at.gradient.dot(slope)};
  Matrix3<Dual> hessian;
  for (int i = 0; i < 3; ++i) {
    out.gradient[i] = {at.gradient[i], gradient_slope[i]};
    for (int j = 0; j < 3; ++j) {
      hessian(i, j) = {at.hessian(i, j), hessian_slope(i, j)};
    }
  }
  const Dual length = sqrt(out.gradient.squaredNorm());
  if (length.value > 0.0) {
    out.n = out.gradient / length;
    out.dn_dx = (hessian - out.n * (out.n.transpose() * hessian)) / length;
  } else {
    out.n = Vector3<Dual>::UnitX();
    out.dn_dx.setZero();
  }
  return out;
}

}  // namespace

template <Scalar S>
SurfaceDistance<S>::SurfaceDistance(const ContactSurface& surface, const Shape& shape,
                                    const Vector3<S>& sizes)
    : sizes_(sizes), values_(sizes.unaryExpr([](const S& size) { return value_of(size); })) {
  if (const auto* plane = std::get_if<Plane>(&surface)) {
    point_ = plane->point;
    normal_ = plane->normal;
  } else if (const auto* field = std::get_if<std::shared_ptr<const DistanceField>>(&surface)) {
    kind_ = Kind::kField;
    field_ = field->get();
  } else if (std::holds_alternative<Cuboid>(shape)) {
    kind_ = Kind::kCuboid;
  } else if (std::holds_alternative<Sphere>(shape)) {
    kind_ = Kind::kSphere;
  } else if (std::holds_alternative<Capsule>(shape)) {
    kind_ = Kind::kCapsule;
  } else if (std::holds_alternative<Cylinder>(shape)) {
    kind_ = std::get<OwnShape>(surface).caps ? Kind::kCylinder : Kind::kTube;
  } else {
    throw InvalidInput("contact: the other body has no shape of its own");
  }
}

template <Scalar S>
SurfaceSample<S> SurfaceDistance<S>::sample(const Vector3<S>& x) const {
  using std::abs;
  switch (kind_) {
    case Kind::kPlane: {
      const Vector3<S> n = normal_.cast<S>();
      return flat_sample<S>(n.dot(x - point_.cast<S>()), n);
    }
    case Kind::kCuboid:
      return faceted_sample<S>(x, sizes_);
    case Kind::kSphere:
      return round_sample<S>(x, sizes_[0], 3);
    case Kind::kCylinder:
    case Kind::kTube: {
      const SurfaceSample<S> side = round_sample<S>(Vector3<S>(x[0], x[1], S(0.0)), sizes_[0], 2);
      const SurfaceSample<S> end =
          flat_sample<S>(abs(x[2]) - 0.5 * sizes_[1], along_axis<S>(2, x[2]));
      if (end.d > 0.0 && side.d > 0.0) {
        return beyond_both<S>(side, end);
      }
      return side.d >= end.d || (kind_ == Kind::kTube && end.d <= 0.0) ? side : end;
    }
    case Kind::kCapsule: {
      const S half = 0.5 * sizes_[1];
      const bool beside = x[2] <= half && x[2] >= -half;
      return round_sample<S>(from_segment<S>(x, half), sizes_[0], beside ? 2 : 3);
    }
    case Kind::kField:
      return field_sample(*field_, x);
  }
  return flat_sample<S>(S(0.0), Vector3<S>::UnitZ());
}

template <Scalar S>
SizeRate<S> SurfaceDistance<S>::by_size(const Vector3<S>& x, int k) const {
  SizeRate<S> out = {S(0.0), Vector3<S>::Zero()};
  switch (kind_) {
    case Kind::kCuboid: {
      const SurfaceSample<S> at = sample(x);
      const Vector3<S> moved = along_axis<S>(k, x[k]) * S(-0.5);  // of the offset
      out.d = at.n.dot(moved);
      out.n = at.dn_dx * moved;
      break;
    }
    case Kind::kSphere:
      out.d = S(-1.0);
      break;
    case Kind::kCylinder:
    case Kind::kTube: {
      const SurfaceSample<S> at = sample(x);
      // Along the offset that this size shortens.
      const Vector3<S> moved =
          k == 0 ? Vector3<S>(-radial<S>(x)) : along_axis<S>(2, x[2]) * S(-0.5);
      out.d = at.n.dot(moved);
      out.n = at.dn_dx * moved;
      break;
    }
    case Kind::kCapsule: {
      const S half = 0.5 * sizes_[1];
      if (k == 0) {
        out.d = S(-1.0);
      } else if (x[2] > half || x[2] < -half) {
        const SurfaceSample<S> at = sample(x);
        const Vector3<S> moved = along_axis<S>(2, x[2]) * S(-0.5);  // of the offset
        out.d = at.n.dot(moved);
        out.n = at.dn_dx * moved;
      }
      break;
    }
    case Kind::kPlane:
    case Kind::kField:
      break;
  }
  return out;
}

template <Scalar S>
int SurfaceDistance<S>::size_count() const {
  switch (kind_) {
    case Kind::kCuboid:
      return 3;
    case Kind::kSphere:
      return 1;
    case Kind::kCylinder:
    case Kind::kTube:
    case Kind::kCapsule:
      return 2;
    case Kind::kPlane:
    case Kind::kField:
      return 0;
  }
  return 0;
}

template class SurfaceDistance<double>;
template class SurfaceDistance<Dual>;

}  // namespace hbar
