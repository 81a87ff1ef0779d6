// Parameters that an interrupt uses as they stand in the table: part of the configuration under their own names, with
// the table's formats.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_CONFIG_VALUES_H
#define STILLSPIN_FIRMWARE_INTERFACES_CONFIG_VALUES_H

#include <stdint.h>

/// Calls `_` with each name.
#define CONFIG_VALUES(_) \
  _(bootstrap_time)      \
  _(current_divider)     \
  _(current_limit)       \
  _(divergence_limit)    \
  _(divergence_time)     \
  _(emergency_stop)      \
  _(encoder_trim)        \
  _(excitation)          \
  _(hold_time)           \
  _(id_low_speed)        \
  _(inertia_adapt)       \
  _(link_maximum)        \
  _(link_minimum)        \
  _(link_regulation)     \
  _(mtpa)                \
  _(overload_current)    \
  _(overload_time)       \
  _(polarity_check)      \
  _(polarity_current)    \
  _(precharge_voltage)   \
  _(rated_current)       \
  _(speed_law)           \
  _(speed_limit)         \
  _(spin_speed)          \
  _(start_current)       \
  _(stop_time)           \
  _(trip_current)        \
  _(voltage_use)         \
  _(weakening_gain)      \
  _(weakening_limit)

#define CONFIG_VALUE(name) int32_t name;
typedef struct {
  CONFIG_VALUES(CONFIG_VALUE)
} config_values_t;
#undef CONFIG_VALUE

#endif
