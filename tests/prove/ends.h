// How large the drive's numbers may be, for the drivers in this folder and for what the floors promise each other.

#ifndef STILLSPIN_TESTS_PROVE_ENDS_H
#define STILLSPIN_TESTS_PROVE_ENDS_H

#define VOLTS_Q16 65536L
#define AMPERES_Q20 1048576L
#define CURRENT_MAX_Q20 (512 * AMPERES_Q20)
#define VOLTAGE_MAX_Q16 (2000 * VOLTS_Q16)
#define RIPPLE_MAX_Q16 (16383 * VOLTS_Q16)
#define CARRIED_MAX_Q20 (1024 * AMPERES_Q20)  // of the frame at its ends, turned back
#define ASKED_MAX_Q16 (8270 * VOLTS_Q16)      // of the modulator
#define SPEED_MAX_BPP 1298773986L             // 1.9 rad per period
#define TURN_MAX_BPP 683565276L               // 1 rad per period: with the current put ahead
#define CHANGE_MAX_Q19 382730240L      // 730 A: what two sensors of 200 A show from end to end, mismatch included
#define RS_NOMINAL_MAX_Q24 352321536L  // 21 ohm
#define Y0_END_Q30 644245094L          // 0.6 A per V and period, in the map (firmware/config/config.c)
#define Y_END_Q30 1288490189L          // 1.2, with what is learnt
#define Y_CROSS_END_Q30 966367641L     // 0.9 across
#define TILT_END_Q24 1073741824L       // 64
#define K0_END_Q20 1073741824L         // 1024 A per period
#define FLUX_END_Q16 2097152000L       // 32000 V, of the map
#define TRIM_FLUX_END_Q16 786432000L   // three eighths of that, learnt
#define LEAST_SHARE_Q24 (-15728640L)   // of the map's inverse inductances, learnt: 15/16 less
#define START_SAMPLES 4                // hal/hal_adc.h
#define END_SAMPLES 3
#define OFFSET_MIN_Q8 491520L                     // 1920 codes (firmware/drive/sequence.c)
#define OFFSET_MAX_Q8 557056L                     // 2176
#define AMPERES_PER_COUNT_MAX_Q36 559240534L      // of 200 A of full scale; counts of twelve products
#define GAIN_MAX_Q36 587210000L                   // of that, with five percent of mismatch
#define WINDOW_ALPHA_MAX_Q20 (224 * AMPERES_Q20)  // what two sensors show at their ends, mismatch and offset included
#define WINDOW_BETA_MAX_Q20 (387 * AMPERES_Q20)
#define WINDOW_VOLTS_MAX_Q16 (1340 * VOLTS_Q16)  // two thirds of 2000 V, and the devices' drops
#define MISMATCH_END_Q30 53687091L               // sensor_match.h
#define SHARE_END_Q12 740000000L                 // of the dead time's band: 1.37 times 1024 A, of any reciprocal
#define VARIANCE_END_Q20 536870912L              // deviation_observer.c
#define POWER_END_Q23 1073741823L                // of scores
#define INFORMATION_END_Q21 16777216L            // of a period, deviation_information.h
#define LEFT_END_Q17 75497472L                   // of a period: 192 A in each of three windows, deviation_observer.c
#define RATIO_MIN_Q24 2097152L                   // of the inertia to the one that the parameters say
#define RATIO_MAX_Q24 134217728L

// In what the functions promise.
#define FROM_TO(x, least, most) ((least) <= (x) && (x) <= (most))
#define WITHIN(x, most) FROM_TO(x, -(most), most)
#define FLAG(x) FROM_TO(x, 0, 1)
#define VECTOR_DQ(v, most) (WITHIN((v).d, most) && WITHIN((v).q, most))
#define VECTOR_AB(v, most) (WITHIN((v).alpha, most) && WITHIN((v).beta, most))
#define VECTOR_ABC(v, most) (WITHIN((v).a, most) && WITHIN((v).b, most) && WITHIN((v).c, most))
#define INVERSE(x) (FROM_TO((x).value, 0, 2147483647) && FROM_TO((x).exponent, 31, 61))

#endif
