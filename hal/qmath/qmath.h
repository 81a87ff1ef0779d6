// Fixed-point mathematics of the drive: everything of floor 0 in one include.
//
// A number's Q format says how many fraction bits it has: x_q30 = round(x * 2^30). Formats and units stand in the names
// of the variables; the functions here only move bits. Nothing in this folder uses floating point, libc, a 64-bit
// division or a target's intrinsics, and every result is the same bit for bit on the DSP and on the host.
//
// Costs in these headers are instructions executed on x86-64 at -O2 (callgrind, mean over arguments of every
// magnitude): an order of magnitude for a machine with a 32 x 32 -> 64 bit multiplier, not cycles of the DSP.
// tests/qmath prints and bounds the worst errors.

#ifndef STILLSPIN_HAL_QMATH_QMATH_H
#define STILLSPIN_HAL_QMATH_QMATH_H

#include "hal/qmath/qangle.h"
#include "hal/qmath/qarith.h"
#include "hal/qmath/qdiv.h"
#include "hal/qmath/qsqrt.h"
#include "hal/qmath/qsum.h"
#include "hal/qmath/qtrig.h"

#endif
