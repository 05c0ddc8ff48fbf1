#include "hbar/core/scene/read_xml.h"

#include <tinyxml2.h>
// planted: third-party
#include <fmt/format.h>
