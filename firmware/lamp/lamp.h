// The first program for a new board: the fault lamp blinks once a second, counted by the crystal. It runs from RAM, so
// a probe and a compiler can be tried before anything is written to the flash; see docs/bring-up.md, stage 0.
//
// The gates stay as the reset has left them, inputs, and their enable line is low and does not move.

#ifndef STILLSPIN_FIRMWARE_LAMP_LAMP_H
#define STILLSPIN_FIRMWARE_LAMP_LAMP_H

#if defined(__cplusplus)
extern "C" {
#endif

/// Never returns. Without crystal or PLL the lamp blinks ten times as slowly, or not at all.
void lamp_main(void);

#if defined(__cplusplus)
}
#endif

#endif
