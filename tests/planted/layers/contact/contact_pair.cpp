#include "hbar/contact/contact_pair.h"

// planted: cycle
#include "hbar/contact/contact_forces.h"
