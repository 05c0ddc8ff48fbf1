#include "picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hbar::finger_reach {
namespace {

using Point = Eigen::Vector2d;
using Points = Eigen::Matrix2Xd;

constexpr const char* kShades[] = {"#c3d9ee", "#8fb8de", "#4f8ec6", "#1f5c99"};
constexpr const char* kInitial = "rx='6' fill='#f4f5f7' stroke='#c4cad3'";
constexpr const char* kBase = "fill='#e4e7eb' stroke='#b4bac3'";
constexpr const char* kPath = "fill='none' stroke='#5d6978' stroke-width='1.1'";
constexpr const char* kRing = "fill='none' stroke='#d9480f' stroke-width='1.5'";
constexpr const char* kAllowed = "fill='#d9480f' fill-opacity='0.15' stroke='#d9480f'";
constexpr const char* kBold = "font-weight='bold'";
constexpr const char* kLabel =
    "font-weight='bold' fill='#d9480f' stroke='#fff' stroke-width='3' paint-order='stroke'";
const Point kLabelPlaces[] = {{34, 4}, {-76, 14}, {14, -20}, {20, 22}};  // from the targets
constexpr double kColumn = 528.0;  // the right one begins here

/// From metres to the picture's pixels, whose second axis points down.
struct View {
  double scale = 1.0;
  Point origin = Point::Zero();
  Point operator()(const Point& p) const { return origin + scale * Point(p.x(), -p.y()); }
};

/// Shows all points in a box, as large as it can.
View fit(const Points& points, const Point& corner, const Point& size) {
  const Point low = points.rowwise().minCoeff();
  const Point high = points.rowwise().maxCoeff();
  const double scale = size.cwiseQuotient(high - low).minCoeff();
  return {scale, corner + 0.5 * (size + scale * Point(-low.x() - high.x(), low.y() + high.y()))};
}

std::string words(const Point& at, const std::string& text, const char* style = "") {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' {}>{}</text>\n", at.x(), at.y(), style, text);
}

std::string circle(const Point& at, double r, const char* style) {
  return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{:.1f}' {}/>\n", at.x(), at.y(), r, style);
}

std::string box(const Point& at, const Point& size, const std::string& style) {
  return fmt::format("<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' {}/>\n", at.x(),
                     at.y(), size.x(), size.y(), style);
}

/// What the tip may be away from a target.
std::string tolerance(const View& view, const Point& target) {
  const double half = view.scale * kHalfWidth;
  return box(view(target) - Point::Constant(half), Point::Constant(2.0 * half), kAllowed);
}

std::string curve(const View& view, const Points& points) {
  std::string out = fmt::format("<path {} stroke-linejoin='round' d='M", kPath);
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    const Point p = view(points.col(k));
    out += fmt::format("{:.1f},{:.1f} ", p.x(), p.y());
  }
  return out + "'/>\n";
}

/// With round ends in a group that says so.
std::string line(const Point& a, const Point& b, double width, const char* colour) {
  return fmt::format(
      "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke-width='{:.2f}' stroke='{}'/>\n",
      a.x(), a.y(), b.x(), b.y(), width, colour);
}

/// Hinges and tip from the side. Here and below, a design is three lengths and three widths.
Points pose(const Point& knuckle, const Eigen::VectorXd& q, const Eigen::VectorXd& design) {
  Points out = knuckle.replicate(1, 4);
  double angle = 0.0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    angle -= q[i + 1];
    out.col(i + 1) = out.col(i) + design[i] * Point(std::cos(angle), std::sin(angle));
  }
  return out;
}

std::string finger(const View& view, const Points& pose, const Eigen::VectorXd& design,
                   double tip_radius, const char* fill, const char* edge) {
  const double widths[] = {design[3], design[4], design[5], 2.0 * tip_radius};
  std::string out = "<g class='finger' stroke-linecap='round'>\n";
  std::string hinges;
  for (const Eigen::Index i : {3, 2, 1, 0}) {
    const Point hinge = view(pose.col(i));
    const Point end = view(pose.col(std::min<Eigen::Index>(i + 1, 3)));
    out += line(hinge, end, view.scale * widths[i] + 2.0, edge);
    out += line(hinge, end, view.scale * widths[i], fill);
    hinges += circle(hinge, i < 3 ? 2.5 : 0.0, "fill='#fff'");
  }
  return out + hinges + "</g>\n";
}

/// Of the ball or cylinder that a link is.
double radius_of(const Link& link) {
  const auto* ball = std::get_if<Sphere>(&link.body.shape);
  const auto* cylinder = std::get_if<Cylinder>(&link.body.shape);
  return ball != nullptr ? ball->radius : cylinder != nullptr ? cylinder->radius : 0.0;
}

std::string side_view(const Reach& reach, const Outcome& outcome) {
  const Eigen::MatrixXd& q = outcome.values.q;
  const Model& model = reach.problem->problem().horizon.model();
  const double tip_radius = radius_of(model.link(model.end_effectors()[0].link));
  const double base = radius_of(model.link(0));
  const Eigen::VectorXd initial = reach.problem->design(outcome.start);
  const Eigen::VectorXd optimum = reach.problem->design(outcome.optimised.result.x);
  const auto tip = outcome.values.v().array();
  const auto yaw = q.row(0).array();
  Points path(2, q.cols() + 4);
  path.row(0).head(q.cols()) = tip.row(0) * yaw.cos() + tip.row(1) * yaw.sin();
  path.row(1).head(q.cols()) = tip.row(2);
  const Point knuckle = path.col(0) - pose(Point::Zero(), q.col(0), optimum).col(3);
  const Points at_rest = path.rightCols(4) = pose(knuckle, q.col(0), initial);
  const View view = fit(path, {36.0, 64.0}, {436.0, 312.0});
  std::string out =
      words({24.0, 30.0}, "In the finger’s plane, which turns with the base", kBold) +
      box(view(knuckle - Point(base, 0.0)), view.scale * Point(2.0 * base, knuckle.y()), kBase) +
      finger(view, at_rest, initial, tip_radius, "#f4f5f7", "#c4cad3");
  std::string marks;
  for (std::size_t n = 0; n < reach.targets.size(); ++n) {
    const auto& [step, position] = reach.targets[n];
    out +=
        finger(view, pose(knuckle, q.col(step), optimum), optimum, tip_radius, kShades[n], "#fff");
    const Point target(position.head<2>().norm(), position.z());
    const std::string label = fmt::format("{} · {:g} s", n + 1, step * outcome.values.h);
    marks += "<g class='target'>\n" + circle(view(target), 6.0, kRing) + tolerance(view, target) +
             words(view(target) + kLabelPlaces[n], label, kLabel) + "</g>\n";
  }
  const double bar = 24.0 + 0.05 * view.scale;
  return out + curve(view, path.leftCols(q.cols())) + marks +
         line({24.0, 407.0}, {bar, 407.0}, 2.0, "#3b4450") + words({bar + 8.0, 411.0}, "50 mm");
}

/// And the tip at each target, enlarged.
std::string top_view(const Reach& reach, const Outcome& outcome) {
  const Points path = outcome.values.v().topRows(2);
  const View view = fit(path, {kColumn + 8.0, 52.0}, {146.0, 150.0});
  const double base = radius_of(reach.problem->problem().horizon.model().link(0));
  std::string out = words({kColumn, 30.0}, "From above", kBold) + "<g stroke-linecap='round'>\n";
  std::string marks = words({kColumn, 244.0}, "Targets 1–4, boxes of 1 mm", kBold);
  for (std::size_t n = 0; n < reach.targets.size(); ++n) {
    const Point target = reach.targets[n].position.head<2>();
    const int step = reach.targets[n].step;
    out += line(view(Point::Zero()), view(target), 6.0, kShades[n]);
    marks += circle(view(target), 4.0, kRing) +
             words(view(target) + Point(8.0, 4.0), std::to_string(n + 1), kLabel);
    const View lens = {2e4, Point(20.0, 20.0) - 2e4 * Point(target.x(), -target.y())};
    const int from = std::max(0, step - 20);
    const int to = std::min(static_cast<int>(path.cols()), step + 21);
    marks += fmt::format("<svg x='{}' y='258' width='40' height='40'>\n",
                         kColumn + 43.0 * static_cast<double>(n)) +
             box({0.5, 0.5}, {39.0, 39.0}, "rx='4' fill='none' stroke='#e4e7eb'") +
             tolerance(lens, target) + curve(lens, path.middleCols(from, to - from)) +
             circle(lens(path.col(step)), 2.5, "fill='#1f5c99'") + "</svg>\n";
  }
  return out + "</g>\n" + circle(view(Point::Zero()), view.scale * base, kBase) +
         curve(view, path) + marks;
}

std::string legend(const Reach& reach, const Outcome& outcome) {
  std::string bar;
  for (int i = 0; i < 4; ++i) {
    bar += box({6.5 * i, -5.0}, {6.5, 10.0}, fmt::format("fill='{}'", kShades[i]));
  }
  const double before = 1e3 * finger_mass(reach, outcome.start);
  const double after = 1e3 * finger_mass(reach, outcome.optimised.result.x);
  const std::string rows[][2] = {
      {box({0, -6}, {26, 12}, kInitial), fmt::format("initial, at rest: {:.0f} g", before)},
      {bar, fmt::format("optimum: {:.0f} g", after)},
      {fmt::format("<path {} d='M0,0h26'/>", kPath), "path of the tip"},
      {circle({13, 0}, 6.0, kRing) + circle({13, 0}, 1.0, "fill='#d9480f'"), "target, ± 0.5 mm"}};
  std::string out;
  for (int i = 0; i < 4; ++i) {
    out += fmt::format("<g transform='translate({} {})'>{}{}</g>\n", kColumn, 328 + 22 * i,
                       rows[i][0], words({36.0, 4.0}, rows[i][1]));
  }
  return out;
}

}  // namespace

std::string picture_svg(const Reach& reach, const Outcome& outcome) {
  return "<svg xmlns='http://www.w3.org/2000/svg' width='720' height='432' viewBox='0 0 720 432' "
         "font-family='Helvetica, Arial, sans-serif' font-size='12' fill='#3b4450'>\n"
         "<rect width='720' height='432' rx='12' fill='#fff'/>\n" +
         side_view(reach, outcome) + top_view(reach, outcome) + legend(reach, outcome) + "</svg>\n";
}

}  // namespace hbar::finger_reach
