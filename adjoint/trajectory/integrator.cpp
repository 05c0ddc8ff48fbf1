#include "hbar/adjoint/trajectory/integrator.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

std::vector<Integrator> make_table() {
  const double a = 1.0 - std::sqrt(0.5);  // α = (2 − √2)/2 of (6)–(9)
  const double own = 1.0 / a;
  const double first = -(1.0 - a) / (a * a);
  return {
      {.name = "bdf1",
       .order = 1,
       .stages = {{.time = 1.0, .own = 1.0, .earlier = {}, .step_ends = {-1.0}}},
       .history = 1,
       .starter = "bdf1"},
      {.name = "sdirk2",
       .order = 2,
       .stages = {{.time = a, .own = own, .earlier = {}, .step_ends = {-own}},
                  {.time = 1.0, .own = own, .earlier = {first}, .step_ends = {-own - first}}},
       .history = 1,
       .starter = "sdirk2"},
      {.name = "bdf2",
       .order = 2,
       .stages = {{.time = 1.0, .own = 1.5, .earlier = {}, .step_ends = {-2.0, 0.5}}},
       .history = 2,
       .starter = "sdirk2"},
  };
}

}  // namespace

const std::vector<Integrator>& integrators() {
  static const std::vector<Integrator> table = make_table();
  return table;
}

const Integrator& find_integrator(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::string known;
  for (const Integrator& row : integrators()) {
    if (row.name == lower) {
      return row;
    }
    known += (known.empty() ? "" : ", ") + row.name;
  }
  throw InvalidInput(concat("there is no integrator '", name, "'; known: ", known));
}

}  // namespace hbar
