#pragma once

// The component hbar::study: solutions in files, many starts, fronts of two objectives,
// identification from measured data.

#include "hbar/adjoint/study/identification.h"
#include "hbar/adjoint/study/information.h"
#include "hbar/adjoint/study/job_table.h"
#include "hbar/adjoint/study/many_starts.h"
#include "hbar/adjoint/study/pareto.h"
#include "hbar/adjoint/study/solution_file.h"
#include "hbar/adjoint/study/trajectory_csv.h"
