#include <IpIpoptApplication.hpp>
#include <IpRegOptions.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include "hbar/solvers/nlp/ipopt.h"
#include "hbar/solvers/nlp/ipopt_run.h"

namespace hbar::solvers {
namespace {

using Option = Ipopt::SmartPtr<const Ipopt::RegisteredOption>;

/// Insertions, deletions and replacements that turn one word into another.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = i;
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t above = row[j + 1];
      row[j + 1] = std::min({above + 1, row[j] + 1, diagonal + (a[i] == b[j] ? 0U : 1U)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

Option find_option(Ipopt::IpoptApplication& application, const std::string& name) {
  const Ipopt::SmartPtr<Ipopt::RegisteredOptions> known = application.RegOptions();
  Option option = known->GetOption(name);
  if (Ipopt::IsValid(option)) {
    return option;
  }
  std::string nearest;
  for (const auto& [other, unused] : known->RegisteredOptionsList()) {
    if (nearest.empty() || edit_distance(name, other) < edit_distance(name, nearest)) {
      nearest = other;
    }
  }
  throw InvalidInput(
      concat("ipopt: unknown option \"", name, "\"; did you mean \"", nearest, "\"?"));
}

const char* type_name(Ipopt::RegisteredOptionType type) {
  switch (type) {
    case Ipopt::OT_Number:
      return "number_options";
    case Ipopt::OT_Integer:
      return "integer_options";
    case Ipopt::OT_String:
      return "string_options";
    default:
      return "none of the option maps";
  }
}

template <typename Value>
void set_option(Ipopt::IpoptApplication& application, const std::string& name, const Value& value) {
  const Option option = find_option(application, name);
  constexpr auto expected = std::is_same_v<Value, double> ? Ipopt::OT_Number
                            : std::is_same_v<Value, int>  ? Ipopt::OT_Integer
                                                          : Ipopt::OT_String;
  if (option->Type() != expected) {
    throw InvalidInput(concat("ipopt: option \"", name, "\" belongs into ",
                              type_name(option->Type()), ", not into ", type_name(expected)));
  }
  bool allowed = false;
  bool taken = false;
  const auto list = application.Options();
  if constexpr (std::is_same_v<Value, double>) {
    allowed = option->IsValidNumberSetting(value);
    taken = allowed && list->SetNumericValue(name, value);
  } else if constexpr (std::is_same_v<Value, int>) {
    allowed = option->IsValidIntegerSetting(value);
    taken = allowed && list->SetIntegerValue(name, value);
  } else {
    allowed = option->IsValidStringSetting(value);
    taken = allowed && list->SetStringValue(name, value);
  }
  if (!taken) {
    throw InvalidInput(concat("ipopt: option \"", name, "\" cannot be ", value, " (",
                              option->ShortDescription(), ")"));
  }
}

void refuse_decided_elsewhere(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kDecided = {
      {{"hessian_approximation", "hessian"},
       {"print_level", "print_level"},
       {"warm_start_init_point", "warm_start"}}};
  for (const auto& [option, member] : kDecided) {
    if (name != option) {
      continue;
    }
    throw InvalidInput(concat("ipopt: option \"", name, "\" is decided by IpoptOptions::", member));
  }
}

template <typename Map>
void set_all(Ipopt::IpoptApplication& application, const Map& values) {
  for (const auto& [name, value] : values) {
    refuse_decided_elsewhere(name);
    set_option(application, name, value);
  }
}

/// Ipopt's own defaults push a warm start into the interior by 1e-3 of the range, which would
/// spoil a solution on its bounds.
void set_warm_start(Ipopt::IpoptApplication& application, double mu) {
  if (!(mu >= 0.0 && std::isfinite(mu))) {
    throw InvalidInput(concat("ipopt: the warm start's mu is ", mu,
                              "; expected a positive number, or 0 where it is not known"));
  }
  constexpr double kPush = 1e-9;
  constexpr double kUnknownMu = 1e-6;
  set_option(application, "warm_start_init_point", std::string("yes"));
  for (const char* name :
       {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
        "warm_start_slack_bound_frac", "warm_start_mult_bound_push"}) {
    set_option(application, name, kPush);
  }
  set_option(application, "mu_init", mu > 0.0 ? mu : kUnknownMu);
}

}  // namespace

std::vector<IpoptOptionInfo> known_ipopt_options() {
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application =
      new Ipopt::IpoptApplication(false);  // NOLINT(hbar-naked-new): the SmartPtr owns it
  std::vector<IpoptOptionInfo> known;
  for (const auto& [name, option] : application->RegOptions()->RegisteredOptionsList()) {
    IpoptOptionInfo info{name, option->ShortDescription(), {}};
    if (option->Type() == Ipopt::OT_Number) {
      info.default_value = option->DefaultNumber();
    } else if (option->Type() == Ipopt::OT_Integer) {
      info.default_value = static_cast<int>(option->DefaultInteger());
    } else {
      info.default_value = option->DefaultString();
    }
    known.push_back(std::move(info));
  }
  return known;
}

void set_ipopt_options(Ipopt::IpoptApplication& application, const IpoptOptions& options) {
  set_option(application, "tol", options.tolerance);
  set_option(application, "constr_viol_tol", options.constraint_tolerance);
  set_option(application, "acceptable_tol", options.acceptable_tolerance);
  set_option(application, "acceptable_constr_viol_tol", options.constraint_tolerance);
  set_option(application, "max_iter", options.max_iterations);
  set_option(application, "print_level", options.print_level);
  set_option(application, "sb", std::string("yes"));
  // The default differs between versions.
  set_option(application, "honor_original_bounds", std::string("yes"));
  if (options.hessian == HessianKind::kLimitedMemory) {
    set_option(application, "hessian_approximation", std::string("limited-memory"));
  }
  if (options.warm_start) {
    set_warm_start(application, options.warm_start->mu);
  }
  set_all(application, options.string_options);
  set_all(application, options.number_options);
  set_all(application, options.integer_options);
}

}  // namespace hbar::solvers
