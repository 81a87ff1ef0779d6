// Parameters that an interrupt uses as they stand in the table: part of the configuration under their own names, with
// the table's formats. Each folder says which of its own they are (config_list.h); the build joins them.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_CONFIG_VALUES_H
#define STILLSPIN_FIRMWARE_INTERFACES_CONFIG_VALUES_H

#include <stdint.h>

#define CONFIG_VALUE(name) int32_t name;
typedef struct {
#include "firmware/interfaces/all_config_values.h"
} config_values_t;
#undef CONFIG_VALUE

#endif
