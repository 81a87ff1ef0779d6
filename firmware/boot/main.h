// The program.

#ifndef STILLSPIN_FIRMWARE_BOOT_MAIN_H
#define STILLSPIN_FIRMWARE_BOOT_MAIN_H

#if defined(__cplusplus)
extern "C" {
#endif

/// The image's entry: never returns.
void firmware_main(void);

#if defined(__cplusplus)
}
#endif

#endif
