#include "hal/qmath/qcall.h"

#include "hal/qmath/qarith.h"

int32_t qc_add_sat(int32_t a, int32_t b) { return q_add_sat(a, b); }

int32_t qc_sub_sat(int32_t a, int32_t b) { return q_sub_sat(a, b); }

int32_t qc_abs_sat(int32_t x) { return q_abs_sat(x); }

int32_t qc_shl_sat(int32_t x, unsigned n) { return q_shl_sat(x, n); }

int32_t qc_follow(int32_t a, int32_t b, unsigned n) { return q_follow(a, b, n); }

int32_t qc_mul(int32_t a, int32_t b, unsigned shift) { return q_mul(a, b, shift); }

int32_t qc_mul_sat(int32_t a, int32_t b, unsigned shift) { return q_mul_sat(a, b, shift); }
