// The one parameter table. Console, bus, storage, host tools and documentation read it; nothing is listed twice.
//
// PARAMETER(id, name, unit, q, decimals, minimum, maximum, default, access, meaning)
//   id        stable for ever; a number is never used again
//   unit      of unit_list.h; what a current, a voltage or both are in is in units of the formats (units.h)
//   q         fractional bits of the value in the firmware (int32_t)
//   minimum, maximum, default: whole numbers in units of 10^-decimals, so that every compiler makes the same constant;
//             those that the board decides are named, see hal/hal_board.h
//   access    STOPPED: only while the power stage is off; ALWAYS: at any time
// No include guard: it is included with different meanings of PARAMETER. The order of the groups
// is that of the table.

// clang-format off
#include "firmware/dictionary/parameters_machine.h"
#include "firmware/dictionary/parameters_control.h"
#include "firmware/dictionary/parameters_start.h"
#include "firmware/dictionary/parameters_comparison.h"
#include "firmware/dictionary/parameters_board.h"
// clang-format on
