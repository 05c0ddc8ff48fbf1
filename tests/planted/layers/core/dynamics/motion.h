#pragma once

#include "hbar/core/model/model.h"
// planted: layer
#include "hbar/contact/contact_forces.h"
// planted: layer
#include "hbar/core/stray/stray.h"
