// What a feature makes of its parameters: constants of its own, exchanged with the drive's configuration.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_CONFIG_PART_H
#define STILLSPIN_FIRMWARE_INTERFACES_CONFIG_PART_H

#include <stdint.h>

struct drive_config;

/// Of a bandwidth or rate, rad/s Q8, times the period: Q30. 100 us 2^22 2^20.
#define CONFIG_PER_PERIOD_Q20 439804651L

typedef struct {
  /// Makes them beside those in use, which an interrupt may read meanwhile, and may change what the drive's own
  /// parameters have made. PACKED_NONE, or why its parameters and the drive's do not fit together, a sentence
  /// (text/packed_text.h). Background level. NULL: `take` alone does it.
  uint16_t (*make)(struct drive_config* c);
  /// What was made last is in use from here on: with the rest of the configuration, between two control interrupts. The
  /// parameters are still those that it was made of. NULL: it keeps none of its own.
  void (*take)(void);
} config_part_t;

/// Those of the edition in their order, NULL behind the last one (editions/).
extern const config_part_t* const edition_config_parts[];

#endif
