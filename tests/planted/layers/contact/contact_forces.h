#pragma once

#include "hbar/core/parameters/parameters.h"
// planted: cycle
#include "hbar/contact/contact_pair.h"
