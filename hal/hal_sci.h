// Serial port to the user, 8N1: octets in and out through two rings in RAM.
//
// The control interrupt moves octets between the port's FIFOs and the rings, a bounded number in each period; the
// background level reads and writes the rings. Octets are values 0..255, one a word. Received octets that find the ring
// full, and frames that were no frames, are lost and counted. Nothing waits.

#ifndef STILLSPIN_HAL_HAL_SCI_H
#define STILLSPIN_HAL_HAL_SCI_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_SCI_RECEIVE_RING 256u   // octets
#define HAL_SCI_TRANSMIT_RING 512u  // octets
// What hal_sci_service can carry: four octets of ten bits in each period of 100 us, each way.
#define HAL_SCI_MAX_BAUD 400000uL
#define HAL_SCI_USUAL_BAUD 115200uL  // until the saved rate is known, and when it cannot be made

// Counts since hal_sci_init; each stays at 65535, but that of the breaks, which begins anew.
typedef struct {
  uint16_t framing;  // characters without a stop bit: noise or a wrong rate
  uint16_t overrun;  // times that the port's FIFO overflowed
  uint16_t breaks;   // the line was held low; the port has been brought back
  uint16_t lost;     // octets for which the receive ring had no room
} hal_sci_errors_t;

// Sets the port up with empty rings; may be called again, which drops what is in the rings and cuts what is being sent.
// baud: bits per second, up to HAL_SCI_MAX_BAUD. Returns false, and changes nothing, for a rate beyond that or one that
// the divider misses by more than 2 %. Background level; needs hal_clock_init.
bool hal_sci_init(uint32_t baud);

// Control interrupt level, once a period: moves at most four octets each way. Does nothing before hal_sci_init.
void hal_sci_service(void);

// Background level. Takes up to `room` received octets; returns how many.
uint16_t hal_sci_read(uint16_t* octets, uint16_t room);

// Background level. True once behind a break: what had come before it and was not read yet is dropped.
bool hal_sci_take_break(void);

// Background level. Hands octets over to be sent, as many as fit; returns how many. Upper halves of words are ignored.
uint16_t hal_sci_write(const uint16_t* octets, uint16_t count);

// Octets that hal_sci_write would take now.
uint16_t hal_sci_room(void);

hal_sci_errors_t hal_sci_errors(void);

#ifdef __cplusplus
}
#endif

#endif
