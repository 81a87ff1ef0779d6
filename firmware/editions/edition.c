// What this image is made of, as tables: the floors below do not know who stands above them.

#include <stddef.h>

#include "firmware/board/functions.h"
#include "firmware/board/selftest.h"
#include "firmware/hysteresis/hysteresis.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/interfaces/service.h"
#include "firmware/mode/interlock.h"
#include "firmware/scope/scope.h"
#include "firmware/sources/flux.h"
#include "firmware/store/store.h"

const phase_control_t* const edition_phase_control = &hysteresis_control;

config_part_t* const edition_config_parts[] = {flux_source_load, NULL};

service_reset_t* const edition_resets[] = {scope_reset, store_reset, board_reset, NULL};

interlock_t* const edition_interlocks[] = {selftest_refusal, board_refusal, NULL};
