#pragma once

// The composition root may.
#include "hbar/scene/description.h"
#include "hbar/scene/description.h"
