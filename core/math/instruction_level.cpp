#include "core/math/instruction_level.h"

namespace orrery {

std::string_view instruction_level() { return ORRERY_LEVEL; }

}  // namespace orrery
