// The state after power-on.

#ifndef STILLSPIN_FIRMWARE_DRIVE_RESET_H
#define STILLSPIN_FIRMWARE_DRIVE_RESET_H

#if defined(__cplusplus)
extern "C" {
#endif

/// Power-on state: clears the drive and what runs beside it, and puts every parameter to its default. firmware_main
/// does it first.
void drive_reset(void);

/// The machine is what the configuration says, and the speed control's constants are made of it.
void drive_machine_reset(void);

#if defined(__cplusplus)
}
#endif

#endif
