// I-F start: a current vector of constant length that turns open-loop, first at rest in two places a quarter turn apart
// (half a turn away from one of them a rotor feels no torque), then along a ramp of its frequency up to the speed at
// which a position source can take over. Source: Wang, Lu, Blaabjerg, IEEE Trans. Ind.
// Appl. 48 (2012), which seed paper B uses ([22]). Steps once per PWM period.
//
// The vector lies on the d-axis of the frame that is controlled; under load the rotor lags by up to 90 degrees. Rotor
// and vector are a spring, w0^2 = p Kt I / J, that nothing damps but friction. So the vector is turned back by w~/w0,
// half of critical damping. w~ is the rotor's speed from the EMF along its mean direction, less the mean of 100 ms:
// what the drops make of it stands still, and counts for nothing. A direction that is off the EMF's by an angle closes
// a loop over the lag with a gain of (w/w0) sin(angle): the component across the vector is off by the lag, and the
// whole voltage by more, where the vector's flux is comparable in size with the magnet's. So the voltage w Ld I that
// the vector takes by itself is taken off before; of an Lq that differs, (Lq - Ld) I sin^2(lag) is left. Above
// 2 w0, where a swing does not reverse the rotor, the direction follows the swing within 13 ms; below, a rotor that
// swings backward would be taken for one that turns forward.
//
// What the damping turns the vector by takes voltage, too: seen as EMF that closes another loop, s Lq I/(lambda w0),
// which gains with frequency up to the current control's and swings there. So w~ is filtered over Lq I/(lambda w0) of
// the configured current at least. Its lag takes damping away with it, 45 degrees of w0 where Lq I is lambda.
//
// A vector can also take over a rotor that turns, to keep it where the source sees nothing or to turn it through
// standstill. For 4 ms, in which a current control of 1000 rad/s or more has settled, its voltage tells no speed, only
// the means to begin with.
// The vector goes to `end_bpp`, in either direction. If the load pulls that rotor out of step it runs away: an
// EMF of twice that of the last speed, for 50 ms, is a failure.
//
// The source takes over when for 300 ms it has been within 80 degrees of the vector and within a quarter of its speed.

#ifndef STILLSPIN_CONTROL_IF_START_H
#define STILLSPIN_CONTROL_IF_START_H

#include "control/machine_model.h"

#define IF_START_AGREED 3000  // periods of agreement: an integrated flux has then lost nine tenths of its first error

typedef struct {
  int32_t current_q20;      // length of the vector, A, up to 100
  int32_t align_periods;    // at rest, over the first half a quarter turn behind and rising, 4..50000
  int32_t step_bpp;         // change of its speed per period, at least 1, up to 1 rad
  int32_t speed_bpp;        // at the end, positive, up to 1 rad per period
  int32_t wait_periods;     // there, until the source agrees
  int32_t damping_periods;  // 1 / w0
  int32_t per_emf_q4;       // bpp per V of EMF
  int32_t reactance_q47;    // V across the vector per A and bpp of it
  int32_t follow_bpp;       // 2 w0: from here on the direction follows a swing
  uint16_t filter_shift;    // of the rotor's speed: over 2^n periods
  int32_t resistance_q24;
  int32_t least_q16;  // mean EMF, V, below which its direction is not looked at
} if_start_config_t;

typedef enum { IF_START_PENDING = 0, IF_START_TAKEN_OVER = 1, IF_START_FAILED = 2 } if_start_result_t;

typedef struct {
  int32_t tick;         // periods since the beginning, at most those at rest
  int32_t speed_bpp;    // of the vector
  int32_t end_bpp;      // that it is to have, with its sign: up to that of the configuration
  uint32_t vector_bam;  // its angle without the damping
  uint32_t angle_bam;   // of the frame to control in
  int32_t current_q20;  // i_d to ask for
  dq_t mean_q16;        // EMF, V, in the frame
  dq_t per_emf_q4;      // bpp of the rotor per V of EMF along and across
  dq_t own_q16;         // V that the vector takes without a magnet: at the resistance, and w Ld I to be turned
  int32_t rotor_bpp;    // speed of the rotor by the EMF, filtered
  int32_t mean_bpp;     // its mean
  int32_t waited;       // periods; below 0: ms in which the EMF has been too large
  int16_t agreed;       // periods; below 0: until the current of a rotor that was taken over has settled
  int16_t sign;         // of the speed that the mean belongs to
  bool took_over;       // a rotor that turned already
} if_start_t;

/// Derives damping and speed from the machine; those before them the caller has given. False where the spring is slower
/// than 1 s or faster than 10 periods.
bool if_start_design(if_start_config_t* c, const machine_model_t* m);

/// angle_bam: where the vector points when it begins to turn.
void if_start_begin(if_start_t* s, const if_start_config_t* c, uint32_t angle_bam, bool backward);

/// The vector takes over a rotor that turns. angle_bam: where it points; current_q20: its length; speed_bpp: of the
/// rotor.
void if_start_begin_turning(if_start_t* s, const if_start_config_t* c, uint32_t angle_bam, int32_t current_q20,
                            int32_t speed_bpp);

/// A vector that took over a rotor turns it as it is commanded, or as fast as the source takes it back.
void if_start_turn_to(if_start_t* s, const if_start_config_t* c, int32_t target_bpp);

/// True once the vector has its last speed.
static inline bool if_start_is_up(const if_start_t* s, const if_start_config_t* c) {
  return s->speed_bpp >= c->speed_bpp || s->speed_bpp <= -c->speed_bpp;
}

/// What changes slowly: once in a millisecond. Before the first time no speed is made of the EMF. voltage: command in
/// the last period, V.
void if_start_renew(if_start_t* s, const if_start_config_t* c, dq_t voltage_q16);

/// One period. voltage: command in the last one, V; seen: angle and speed of the source.
if_start_result_t if_start_step(if_start_t* s, const if_start_config_t* c, dq_t voltage_q16, uint32_t seen_bam,
                                int32_t seen_bpp);

#endif
