#pragma once

#include <vector>

#include "hbar/core/model/model.h"
#include "hbar/core/parameters/parameter.h"

namespace hbar::detail {

// The `list` entries of the table of kinds (parameter_kinds.h): each function appends an owner's
// parameters of one kind, with names, units, nominal values and bounds.

using ParameterList = std::vector<Parameter>;

void list_joint_transform(const Model& model, int link, ParameterList& out);
void list_body_transform(const Model& model, int link, ParameterList& out);
void list_contact_points(const Model& model, int link, ParameterList& out);
void list_mass(const Model& model, int link, ParameterList& out);
void list_inertia(const Model& model, int link, ParameterList& out);
void list_stiffness(const Model& model, int link, ParameterList& out);
void list_damping(const Model& model, int link, ParameterList& out);
void list_contact_scale(const Model& model, int link, ParameterList& out);
void list_motor_P(const Model& model, int motor, ParameterList& out);
void list_motor_D(const Model& model, int motor, ParameterList& out);
void list_gravity(const Model& model, int, ParameterList& out);
void list_contact_coefficients(const Model& model, int contact, ParameterList& out);
void list_sizes(const Model& model, int link, ParameterList& out);

}  // namespace hbar::detail
