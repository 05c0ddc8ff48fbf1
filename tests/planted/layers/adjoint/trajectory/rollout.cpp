// planted: third-party
#include <coin/IpTNLP.hpp>
