#include <sys/wait.h>

#include "hbar/adjoint/tangent.h"
#include "hbar/scene/atomic_file.h"
#include "hbar/solvers/ipopt.h"
#include "hbar/study/pareto.h"
// planted: third-party
#include <coin/IpTNLP.hpp>
// planted: floor
#include "hbar/examples/progress.h"
