#include <CLI/CLI.hpp>

#include "finger_map.h"
#include "hbar/adjoint/trajectory/rollout.h"
// planted: third-party
#include <gtest/gtest.h>
// planted: third-party
#include <lapacke.h>
