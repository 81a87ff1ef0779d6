// What a feature makes of its parameters: a part of the drive's configuration.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_CONFIG_PART_H
#define STILLSPIN_FIRMWARE_INTERFACES_CONFIG_PART_H

#include <stdbool.h>

struct drive_config;

/// Adds it to what the drive's own parameters have made. False where they do not fit together.
typedef bool config_part_t(struct drive_config* c);
/// Those of the edition in their order, NULL behind the last one (editions/).
extern config_part_t* const edition_config_parts[];

#endif
