// Parameters that may be changed now: in their range, and where the drive does not rest on them while it is on.

#include <stddef.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/mode.h"

parameter_result_t parameter_settable(const parameter_info_t* info, int32_t raw) {
  if (info == NULL) return SET_UNKNOWN;
  if (!parameter_allows(info, raw)) return SET_RANGE;
  if (info->access == PARAMETER_ALWAYS) return SET_OK;
  drive_parameters_changed();  // from here on no start is taken, so what is seen next stays true
  return drive_is_energised() ? SET_RUNNING : SET_OK;
}

void parameter_change(const parameter_info_t* info, int32_t raw) {
  *parameter_in_use(info) = raw;
  drive_parameters_changed();
}

parameter_result_t parameter_set(uint16_t id, int32_t raw) {
  const parameter_info_t* const info = parameter_by_id(id);
  const parameter_result_t result = parameter_settable(info, raw);
  if (result == SET_OK) parameter_change(info, raw);
  return result;
}
