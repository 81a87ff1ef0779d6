// Loading at power-on: the drive stays in BOOT until what was saved is in force, with the configuration that goes with
// it.

#ifndef STILLSPIN_FIRMWARE_STORE_POWER_ON_H
#define STILLSPIN_FIRMWARE_STORE_POWER_ON_H

#if defined(__cplusplus)
extern "C" {
#endif

/// Sets the memory up and begins, then goes on with it.
void store_load_at_power_on(void);

/// In every pass, behind the store's own service and the drive's, which take what was loaded.
void store_end_loading(void);

#if defined(__cplusplus)
}
#endif

#endif
