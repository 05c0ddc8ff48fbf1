#include "hbar/adjoint/study/pareto.h"

#include <sys/wait.h>

#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/core/files/atomic_file.h"
#include "hbar/solvers/nlp/ipopt.h"
// planted: third-party
#include <coin/IpTNLP.hpp>
// planted: layer
#include "hbar/examples/progress.h"
