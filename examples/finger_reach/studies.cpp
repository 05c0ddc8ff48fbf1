#include "studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "hbar/solvers/nlp/sensitivity.h"
#include "report.h"

namespace hbar::finger_reach {
namespace {

using solvers::HessianKind;

/// The name in a table, and what Ipopt made of it.
std::string line_of(const Way& way) {
  return fmt::format("{:<18} {:<15} {:>6} {:>6} {:>6} {:>6} {:>9.2f} s {:>12.9f} {:>9.1e}  {}\n",
                     name_of(way.formulation), example::name_of(way.hessian), way.variables,
                     way.constraints, way.result.iterations, way.result.evaluations.objective,
                     way.result.elapsed, way.result.objective, way.result.violation.relative,
                     to_string(way.result.status));
}

std::string heading() {
  return fmt::format("{:<18} {:<15} {:>6} {:>6} {:>6} {:>6} {:>11} {:>12} {:>9}\n", "formulation",
                     "Hessian", "x", "c", "iter.", "f", "time", "effort", "violation");
}

double effort_of(const TrajectoryValues& values) { return 0.5 * values.h * values.u.squaredNorm(); }

}  // namespace

std::vector<Way> solve_every_way(const std::filesystem::path& scene, int steps,
                                 const example::OptimiseArguments& arguments) {
  std::vector<Way> ways;
  example::print(heading());
  for (const Formulation formulation :
       {Formulation::kShooting, Formulation::kMultipleShooting, Formulation::kAllAtOnce}) {
    for (const HessianKind hessian :
         {HessianKind::kExact, HessianKind::kGaussNewton, HessianKind::kLimitedMemory}) {
      const Reach reach = make_reach(
          scene, {.steps = steps,
                  .transcription = {.formulation = formulation, .segments = arguments.segments},
                  .segments = arguments.segments});
      solvers::IpoptOptions options = ipopt_options(arguments.max_iterations);
      options.tolerance = 1e-8;  // so that optima can be compared
      options.hessian = hessian;
      options.stop = &example::stop_flag();
      const solvers::IpoptResult result = solvers::solve_with_ipopt(*reach.problem, options);
      ways.push_back({.formulation = formulation,
                      .hessian = hessian,
                      .variables = result.x.size(),
                      .constraints = result.c.size(),
                      .result = result,
                      .head = result.x.head(reach.problem->input_variables().size())});
      example::print(line_of(ways.back()));
      if (example::stop_flag()) {
        return ways;
      }
    }
  }
  return ways;
}

std::string ways_table(const std::vector<Way>& ways) {
  const auto converged = [](const Way& way) { return way.result.converged(); };
  const auto first = std::find_if(ways.begin(), ways.end(), converged);
  if (first == ways.end()) {
    return "none converged\n";
  }
  double effort = 0.0;
  double sizes = 0.0;
  double controls = 0.0;
  for (const Way& way : ways) {
    if (converged(way)) {
      const Eigen::VectorXd apart = (way.head - first->head).cwiseAbs();
      effort = std::max(effort, std::abs(way.result.objective / first->result.objective - 1.0));
      sizes = std::max(sizes, apart.head<6>().maxCoeff());
      controls = std::max(controls, apart.tail(apart.size() - 6).maxCoeff());
    }
  }
  return fmt::format(
      "{} of {} converged; their optima are apart by at most {:.1e} of the effort, {:.1e} mm of a "
      "size, {:.1e} of a control\n",
      std::count_if(ways.begin(), ways.end(), converged), ways.size(), effort, 1e3 * sizes,
      controls);
}

std::vector<FrontPoint> front_of_mass(const std::filesystem::path& scene, int steps,
                                      const example::OptimiseArguments& arguments,
                                      const std::vector<double>& weights, const SaveFront& save) {
  const TranscriptionOptions transcription = example::transcription_options(arguments);
  Eigen::Index designs = 0;
  const auto front_of = [&designs](const std::vector<study::ParetoPoint>& points) {
    std::vector<FrontPoint> front;
    for (const study::ParetoPoint& point : points) {
      front.push_back({point, point.optimum.point.x.head(designs)});
    }
    return front;
  };
  std::vector<study::ParetoPoint> so_far;
  const std::vector<study::ParetoPoint> points =
      study::pareto_sweep(weights, [&](double weight, const solvers::PrimalDualPoint* warm) {
        const Reach reach = make_reach(scene, {.steps = steps,
                                               .transcription = transcription,
                                               .effort_weight = weight,
                                               .mass_weight = 1.0 - weight});
        solvers::IpoptOptions options = ipopt_options(arguments.max_iterations);
        options.hessian = example::find_hessian(arguments.hessian);
        options.stop = &example::stop_flag();
        if (warm != nullptr) {
          options.warm_start = *warm;
          options.number_options["mu_init"] = 1e-3;
        }
        const solvers::IpoptResult result = solvers::solve_with_ipopt(*reach.problem, options);
        designs = reach.problem->input_variables().design_count();
        const study::WeightedOptimum optimum{
            .converged = result.converged(),
            .f1 = effort_of(reach.problem->trajectory_values(result.x)),
            .f2 = finger_mass(reach, result.x),
            .point = result.point(),
            .message =
                fmt::format("{} after {} iterations", to_string(result.status), result.iterations)};
        so_far.push_back({.weight = weight, .optimum = optimum});
        save(front_of(so_far));
        return optimum;
      });
  return front_of(points);
}

std::string front_csv(const std::vector<FrontPoint>& front) {
  std::string text =
      "weight,effort,mass,length.proximal,length.middle,length.distal,width.proximal,width.middle,"
      "width.distal,converged,dominated\n";
  for (const FrontPoint& at : front) {
    fmt::format_to(std::back_inserter(text), "{:.17g},{:.17g},{:.17g}", at.point.weight,
                   at.point.optimum.f1, at.point.optimum.f2);
    for (const double size : at.design) {
      fmt::format_to(std::back_inserter(text), ",{:.17g}", size);
    }
    text += fmt::format(",{:d},{:d}\n", at.point.optimum.converged, at.point.dominated);
  }
  return text;
}

std::string front_table(const std::vector<FrontPoint>& front) {
  std::string text = fmt::format("{:>8} {:>10} {:>10} {:>24} {:>22}\n", "weight", "effort", "mass",
                                 "lengths", "widths");
  for (const FrontPoint& at : front) {
    const Eigen::VectorXd mm = 1e3 * at.design;
    text += fmt::format(
        "{:>8.3f} {:>10.6f} {:>8.3f} g {:>7.2f} {:>7.2f} {:>7.2f}  {:>6.2f} {:>6.2f} {:>6.2f} mm  "
        "{}{}\n",
        at.point.weight, at.point.optimum.f1, 1e3 * at.point.optimum.f2, mm[0], mm[1], mm[2], mm[3],
        mm[4], mm[5], at.point.optimum.message, at.point.dominated ? ", dominated" : "");
  }
  return text;
}

std::string sensitivity_table(const Reach& reach, const solvers::IpoptResult& optimum) {
  Transcription& program = *reach.problem;
  const DesignVariables& design = program.problem().map->variables();
  const auto payload = static_cast<int>(design.size()) - 1;
  const solvers::Sensitivity answer =
      solvers::sensitivity_of_optimum(program, optimum.point(), {payload});
  std::string text =
      fmt::format("effort by a payload: {:+.6f} per g\n", 1e-3 * answer.df_dtheta[0]);
  for (Eigen::Index i = 0; i < payload; ++i) {
    text += fmt::format("  {:<18} {:+.5f} mm per g\n", design.names[static_cast<std::size_t>(i)],
                        answer.dx_dtheta(i, 0));
  }
  const std::vector<std::string>& names = program.constraint_limits().names;
  const auto limit = std::find(names.begin(), names.end(), "total mass");
  text += fmt::format("effort by the mass limit: {:+.6f} per g\n",
                      -1e-3 * optimum.constraint_multipliers[limit - names.begin()]);
  for (const std::string& name : answer.weakly_active) {
    text += fmt::format("  on a bound, but hardly held by it: {}\n", name);
  }
  return text;
}

}  // namespace hbar::finger_reach
