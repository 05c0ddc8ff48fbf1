#include "hbar/core/parameters/parameters.h"

#include <algorithm>
#include <tuple>
#include <unordered_map>

#include "hbar/core/base/error.h"
#include "hbar/core/base/nearest_name.h"
#include "hbar/core/model/moments.h"
#include "hbar/core/parameters/parameter_kinds.h"

namespace hbar {
namespace {

/// Calls visit(prefix) for a name and each of its prefixes that ends before a dot, but the empty
/// one.
template <typename Visit>
void for_each_prefix(std::string_view name, const Visit& visit) {
  for (std::size_t end = 1; end <= name.size(); ++end) {
    if (end == name.size() || name[end] == '.') {
      visit(name.substr(0, end));
    }
  }
}

[[noreturn]] void refuse_value(const Parameter& parameter, double value, const char* range) {
  throw InvalidInput(concat(parameter.name, " is ", value, "; it must be ", range));
}

void require_physical(const Model& model, const Eigen::VectorXd& mass,
                      const Eigen::Matrix3Xd& moments) {
  for (Eigen::Index i = 0; i < mass.size(); ++i) {
    const std::string& body = model.link(static_cast<int>(i)).body.name;
    if (!(mass[i] > 0.0)) {
      throw InvalidInput(concat("body.", body, ".mass is ", mass[i], "; it must be positive"));
    }
    const Eigen::Vector3d I = moments.col(i);
    if (!(I.minCoeff() > 0.0) || excess_of_moments(I) > kRoundedMoments) {
      throw InvalidInput(concat("body.", body, ".inertia is (", listed(I),
                                "); moments must be positive and none may exceed the sum of the "
                                "other two (see inertia_chart for a chart that keeps to that)"));
    }
  }
}

}  // namespace

namespace {

/// Where list_parameters puts a kind of an owner.
std::tuple<ParameterKind, int, ParameterKind> place(ParameterKind kind, int owner) {
  ParameterKind group = kind;
  while (row_of(group).with_previous) {
    group = static_cast<ParameterKind>(static_cast<int>(group) - 1);
  }
  return {group, owner, kind};
}

}  // namespace

ParameterSet::ParameterSet(std::vector<Parameter> parameters) {
  Data data{std::move(parameters), {}};
  for (int i = 0; i < static_cast<int>(data.parameters.size()); ++i) {
    const Parameter& parameter = data.parameters[static_cast<std::size_t>(i)];
    if (data.blocks.empty() || data.blocks.back().kind != parameter.kind ||
        data.blocks.back().owner != parameter.owner) {
      data.blocks.push_back({parameter.kind, parameter.owner, i, 0});
    }
    ++data.blocks.back().size;
  }
  data_ = std::make_shared<const Data>(std::move(data));
}

ParameterSet ParameterSet::all(const Model& model) { return ParameterSet(list_parameters(model)); }

ParameterSet ParameterSet::masked(const Model& model) {
  std::vector<Parameter> chosen;
  for (Parameter& parameter : list_parameters(model)) {
    const unsigned bit = row_of(parameter.kind).mask_bit;
    if (bit != 0 && (model.link(parameter.owner).design_mask & bit) != 0) {
      chosen.push_back(std::move(parameter));
    }
  }
  return ParameterSet(std::move(chosen));
}

ParameterSet ParameterSet::named(const Model& model, const std::vector<std::string>& names) {
  std::vector<Parameter> every = list_parameters(model);
  std::unordered_map<std::string_view, bool> selects;  // by name or prefix: whether it does
  for (const std::string& name : names) {
    selects.emplace(name, false);
  }
  std::vector<bool> wanted(every.size(), false);
  for (std::size_t i = 0; i < every.size(); ++i) {
    for_each_prefix(every[i].name, [&](std::string_view prefix) {
      const auto found = selects.find(prefix);
      if (found != selects.end()) {
        found->second = true;
        wanted[i] = true;
      }
    });
  }
  for (const std::string& name : names) {
    if (!selects.at(name)) {
      std::vector<std::string> known;
      for (const Parameter& parameter : every) {
        known.push_back(parameter.name);
      }
      throw InvalidInput(
          concat("there is no parameter '", name, "'; ", unknown_name_hint(name, known)));
    }
  }
  std::vector<Parameter> chosen;
  for (std::size_t i = 0; i < every.size(); ++i) {
    if (wanted[i]) {
      chosen.push_back(std::move(every[i]));
    }
  }
  return ParameterSet(std::move(chosen));
}

int ParameterSet::find(std::string_view name) const {
  std::vector<std::string> known;
  for (int i = 0; i < size(); ++i) {
    if ((*this)[i].name == name) {
      return i;
    }
    known.push_back((*this)[i].name);
  }
  throw InvalidInput(
      concat("parameter '", name, "' is not in the set; ", unknown_name_hint(name, known)));
}

int ParameterSet::index(ParameterKind kind, int owner, int component) const {
  const auto block = std::lower_bound(
      blocks().begin(), blocks().end(), place(kind, owner),
      [](const ParameterBlock& b, const auto& wanted) { return place(b.kind, b.owner) < wanted; });
  if (block == blocks().end() || block->kind != kind || block->owner != owner) {
    return -1;
  }
  const auto first = parameters().begin() + block->first;
  const auto found = std::lower_bound(
      first, first + block->size, component,
      [](const Parameter& parameter, int wanted) { return parameter.component < wanted; });
  return found != first + block->size && found->component == component
             ? static_cast<int>(found - parameters().begin())
             : -1;
}

namespace {

template <typename Field>
Eigen::VectorXd gather(const std::vector<Parameter>& parameters, Field field) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    out[i] = parameters[static_cast<std::size_t>(i)].*field;
  }
  return out;
}

}  // namespace

Eigen::VectorXd ParameterSet::nominal() const { return gather(parameters(), &Parameter::nominal); }
Eigen::VectorXd ParameterSet::lower() const { return gather(parameters(), &Parameter::lower); }
Eigen::VectorXd ParameterSet::upper() const { return gather(parameters(), &Parameter::upper); }

void require_parameters_of(const Model& model, const ParameterSet& set) {
  if (set.size() == 0) {
    return;
  }
  const std::vector<Parameter> every = list_parameters(model);
  std::unordered_map<std::string_view, const Parameter*> own;
  for (const Parameter& parameter : every) {
    own.emplace(parameter.name, &parameter);
  }
  for (const Parameter& parameter : set.parameters()) {
    const auto found = own.find(parameter.name);
    if (found == own.end()) {
      throw InvalidInput(concat("the parameter set is of another model: '", model.name(),
                                "' has no parameter '", parameter.name, "'"));
    }
    if (*found->second != parameter) {
      throw InvalidInput(concat("the parameter set is of another model: ", parameter.name, " is ",
                                parameter.nominal, " there and ", found->second->nominal, " in '",
                                model.name(), "', or has another place or other bounds"));
    }
  }
}

void require_in_range(const ParameterSet& set, const Eigen::VectorXd& p) {
  if (p.size() != set.size()) {
    throw InvalidInput(concat("p has ", p.size(), " entries; the parameter set has ", set.size()));
  }
  for (int i = 0; i < set.size(); ++i) {
    const ParameterRange range = row_of(set[i].kind).range;
    if (range == ParameterRange::kNonNegative && p[i] < 0.0) {
      refuse_value(set[i], p[i], "≥ 0");
    }
    if (range == ParameterRange::kPositive && !(p[i] > 0.0)) {
      refuse_value(set[i], p[i], "positive");
    }
  }
}

void round_into_range(const ParameterSet& set, Eigen::VectorXd& p) {
  constexpr double kRelaxed = 1e-6;
  for (int i = 0; i < set.size(); ++i) {
    const bool rounded = p[i] < 0.0 && p[i] > -kRelaxed * std::max(1.0, std::abs(set[i].nominal));
    if (rounded && row_of(set[i].kind).range == ParameterRange::kNonNegative) {
      p[i] = 0.0;
    }
  }
}

template <Scalar S>
void apply_parameters(const Model& model, const ParameterSet& set, const VectorView<S>& p,
                      Mechanism<S>& mechanism) {
  if (p.size() != set.size()) {
    throw InvalidInput(concat("p has ", p.size(), " entries; the parameter set has ", set.size()));
  }
  for (int i = 0; i < set.size(); ++i) {  // what is divided by
    if (row_of(set[i].kind).range == ParameterRange::kPositive && !(value_of(p[i]) > 0.0)) {
      refuse_value(set[i], value_of(p[i]), "positive");
    }
  }
  mechanism = nominal_mechanism<S>(model);
  std::vector<ParameterValue<S>> values;
  for (const ParameterBlock& block : set.blocks()) {
    values.clear();
    for (int i = block.first; i < block.first + block.size; ++i) {
      if (!std::isfinite(value_of(p[i]))) {
        throw InvalidInput(concat(set[i].name, " is ", value_of(p[i]), "; it must be finite"));
      }
      values.push_back({set[i].component, p[i]});
    }
    row_of(block.kind).actions<S>().apply(model, block.owner, values, mechanism);
  }
  require_physical(model, mechanism.mass.unaryExpr([](const S& m) { return value_of(m); }),
                   mechanism.moments.unaryExpr([](const S& m) { return value_of(m); }));
  mechanism.update_derived(model);
}

template void apply_parameters(const Model&, const ParameterSet&, const VectorView<double>&,
                               Mechanism<double>&);
template void apply_parameters(const Model&, const ParameterSet&, const VectorView<Dual>&,
                               Mechanism<Dual>&);

}  // namespace hbar
