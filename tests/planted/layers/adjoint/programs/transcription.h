#pragma once

// planted: layer
#include "hbar/core/scene/description.h"
