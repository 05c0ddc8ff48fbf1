#pragma once

// The composition root may.
#include "hbar/contact/contact_force.h"
#include "hbar/scene/description.h"
