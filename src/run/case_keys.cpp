#include "run/case_keys.hpp"

namespace breccia {

BR_ALL_CASE_KEYS()

}  // namespace breccia
