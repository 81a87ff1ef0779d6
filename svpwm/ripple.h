// The switching ripple that a pattern makes, as the flux by which the machine departs from its course without ripple.
//
// For a leg with pulse [r, f] of a period N, the integral of (leg voltage - its mean) from the start of the period is
//   Vdc [ clamp(t - r, 0, f - r) - (f - r) t / N ],
// zero at both ends of every period whatever the pattern. Divided by the inductance it is the ripple current: it turns
// a sample taken anywhere into the current without ripple, and that into the current at an edge. The reference is the
// current at the period's ends and not its mean over the period, because patterns change from period to period: the
// ends are continuous, while the mean jumps when the order of the pulses is turned round.

#ifndef STILLSPIN_SVPWM_RIPPLE_H
#define STILLSPIN_SVPWM_RIPPLE_H

#include "svpwm/pattern.h"

/// Ripple flux at some ticks together, up to three, V * period, Q16 (multiply by T/L to have amperes).
ab_t svpwm_ripple_q16(const svpwm_pulses_t* p, const int16_t ticks[], uint16_t count, int32_t link_q16);

/// Mean voltage of a period with these pulses, V Q16.
ab_t svpwm_mean_q16(const svpwm_pulses_t* p, int32_t link_q16);

/// Ripple current of each edge's own phase at that edge, A Q20. admittance_q30: mean T/L, A per V and period; link_q16:
/// DC link, V; together up to 1000 A.
void svpwm_edge_ripple_q20(const svpwm_pulses_t* p, int32_t admittance_q30, int32_t link_q16,
                           int32_t at_q20[SVPWM_EDGES]);

#endif
