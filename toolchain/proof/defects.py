"""The defects that are planted, each to be found in the function where it is."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Defect:
    """One change of the sources, and the part and function in which it has to show."""

    part: str
    function: str
    file: str
    right: str
    wrong: str


DEFECTS = (
    Defect("arithmetic", "q15_mul", "hal/qmath/qarith.h", "(int32_t)a * b + 0x4000L", "a * b + 0x4000L"),
    Defect("arithmetic", "q_neg_sat", "hal/qmath/qarith.h", "(x == INT32_MIN) ? INT32_MAX : -x", "-x"),
    Defect(
        "arithmetic", "q_follow", "hal/qmath/qarith.h", "a + q_shr(q_sub_sat(b, a), n)", "b + q_shr(q_sub_sat(b, a), n)"
    ),
    Defect(
        "arithmetic", "q_mix", "hal/qmath/qarith.h", "a + q_mul(b - a, share, bits)", "b + q_mul(b - a, share, bits)"
    ),
    Defect("quotients", "q_reciprocal_q31", "hal/qmath/qdiv.c", "[(divisor >> 24) - 128]", "[(divisor >> 24) - 127]"),
    Defect("quotients", "q_invert", "hal/qmath/qdiv.c", "(divisor > 0) ?", "(divisor >= 0) ?"),
    Defect("roots", "guess_q15", "hal/qmath/qsqrt.c", "(m_q32 >> 28) - 4u", "(m_q32 >> 28) - 3u"),
    Defect("angles", "sincos_of_quadrant", "hal/qmath/qtrig.c", "sine_q30[node]", "sine_q30[node + 1u]"),
    Defect(
        "interrupt",
        "hal_adc_read_window",
        "firmware/drive/sampling.c",
        "(place < ESTIMATOR_WINDOWS)",
        "(place < ESTIMATOR_WINDOWS + 1u)",
    ),
    Defect(
        "interrupt",
        "run_train",
        "firmware/commissioning/map.c",
        "if (segment < SEGMENTS) {",
        "if (segment <= SEGMENTS) {",
    ),
    Defect(
        "interrupt",
        "add_period",
        "firmware/commissioning/staircase.c",
        "s->index >= STAIRCASE_LEVELS",
        "s->index > STAIRCASE_LEVELS",
    ),
    Defect(
        "interrupt",
        "calibrate",
        "firmware/drive/sequence.c",
        "d->supervision.missing > SAMPLES_TIMEOUT",
        "SAMPLES_TIMEOUT / d->supervision.missing < 1u",
    ),
    Defect(
        "svpwm",
        "alternate",
        "svpwm/modulator.c",
        "(uint32_t)c->pulse_ticks * FOUR",
        "(int32_t)c->pulse_ticks * 99 * (int32_t)FOUR",
    ),
    Defect("turned", "turned", "estimators/deviation.c", "q_mul_hi(x_q30, x_q30) * 2", "q_mul_hi(x_q30, x_q30) * 16"),
    Defect("limits", "q_sat_bits", "hal/qmath/qarith.h", "q_shr64(x, n + bits)", "q_shr64(x, n + bits + 1u)"),
    Defect(
        "shifts",
        "q_shr",
        "hal/qmath/qarith.h",
        "return x >> n; }\n\n// floor(x / 2^n), n = 0..63",
        "return (int32_t)((uint32_t)x >> n); }\n\n// floor(x / 2^n), n = 0..63",
    ),
    Defect(
        "between", "q_follow", "hal/qmath/qarith.h", "a + q_shr(q_sub_sat(b, a), n)", "a - q_shr(q_sub_sat(b, a), n)"
    ),
    Defect("between", "q_limit", "hal/qmath/qarith.h", "<= 2u * (uint32_t)limit)", "<= 2u * (uint32_t)limit + 1u)"),
    Defect("layouts", "most_of_both", "svpwm/extended.c", "(room + t1 + t2) / 2", "(room + t1 + t2 + 2) / 2"),
    Defect(
        "layouts",
        "svpwm_long_zero",
        "svpwm/extended.c",
        "2u, SVPWM_FIRST_TICK, common",
        "2u, SVPWM_FIRST_TICK - 1, common",
    ),
    Defect(
        "words",
        "number_with_unit",
        "firmware/console/words_of_line.c",
        "(uint16_t)(value->count - length)",
        "value->count",
    ),
    Defect("edges", "svpwm_take_window", "svpwm/windows.c", "window_count < c->windows", "window_count <= c->windows"),
    Defect(
        "control",
        "machine_torque_constant_q24",
        "control/machine_model.c",
        "q_product(m->torque_q24, ONE_Q20)",
        "(m->torque_q24 * ONE_Q20)",
    ),
    Defect(
        "estimators",
        "follow_angle",
        "estimators/tracking_observer.c",
        "q_clamp(before + change, -SPEED_END_BPP, SPEED_END_BPP)",
        "before + change",
    ),
    Defect(
        "estimators",
        "voltage_match_step",
        "estimators/voltage_match.c",
        "t->psi_q16 = qc_sub_sat(t->psi_q16, q",
        "t->psi_q16 = (t->psi_q16 - q",
    ),
    # What a function promises is taken behind it, so it shows there.
    Defect(
        "observer",
        "deviation_observer_step",
        "estimators/deviation_observer.c",
        "q_limit(s->speed_bpp + ",
        "q_max(s->speed_bpp + ",
    ),
    Defect(
        "look",
        "leave_after",
        "estimators/deviation_observer.c",
        "left->periods >= LEFT_PERIODS_MAX",
        "left->periods > LEFT_PERIODS_MAX",
    ),
    Defect("flux", "leaked", "estimators/stator_flux.c", "q_add_sat(flux, q_mul", "(flux + q_mul"),
    Defect(
        "configuration",
        "config_slow_bpp",
        "firmware/interfaces/config.h",
        "rpm * c->bpp_per_rpm_q8",
        "rpm * 100 * c->bpp_per_rpm_q8",
    ),
    Defect(
        "configuration", "load_machine", "firmware/config/config.c", "pole_pairs * 1832519L", "pole_pairs * 183251900L"
    ),
    Defect(
        "flux",
        "flux_adaptation_change_q24",
        "estimators/flux_adaptation.c",
        "qc_sub_sat(length_q24, along_q24)",
        "length_q24 - along_q24",
    ),
    Defect("start", "polarity_step", "estimators/polarity.c", "qc_add_sat(s->response_bam, m", "(s->response_bam + m"),
    Defect(
        "start", "saturation_resistance_q24", "estimators/saturation.c", "return q_neg_sat(q_div(", "return -(q_div("
    ),
    Defect("commissioning", "take_off", "estimators/fit.c", "rest[FIT_POINTS]", "rest[FIT_POINTS - 1u]"),
    Defect("packed_before", "next_code", "firmware/text/packed_text.c", "if (entry == SPELLED) skip_word(at);", ""),
    Defect("numbers", "put_digits", "firmware/text/text.c", "reversed[10]", "reversed[9]"),
    Defect("names", "goes_on_with", "firmware/text/packed_text.c", "k < count; k++) {", "k <= count; k++) {"),
    Defect("near", "suggest_is_near", "firmware/console/suggest/suggest.c", "if (left > 1u &&", "if (left > 0u &&"),
    Defect("editor", "insert", "firmware/console/editor.c", "l->count >= EDITOR_LINE", "l->count > EDITOR_LINE"),
    Defect("commands", "scope_set_channels", "firmware/scope/commands_setup.c", "a->count > 1u +", "a->count > 2u +"),
    Defect("requests", "scope_read", "firmware/scope/requests.c", "count > READ_MAX", "count > 2u * READ_MAX"),
    Defect("requests", "delta_take", "firmware/hil/hil.c", "shape[2] > REPLAY_INPUTS", "shape[2] > 2u * REPLAY_INPUTS"),
    Defect("console", "keep", "firmware/console/console.c", "kept_count) & (KEPT - 1u)", "kept_count) & KEPT"),
    Defect("node", "can_put", "firmware/can/messages.c", "&frame->data[at >> 3]", "&frame->data[at >> 2]"),
    Defect("blocks", "cobs_decode", "firmware/link/cobs.c", "from = 0; from < count", "from = 0; from <= count"),
    Defect(
        "framing", "splitter_octet", "firmware/link/splitter.c", "<= RECORD_ENCODED_MAX)", "<= RECORD_ENCODED_MAX + 1u)"
    ),
    Defect("framing", "take", "firmware/can/segments.c", "j->count >= RECORD_MAX", "j->count > RECORD_MAX"),
    Defect("store", "take_header", "firmware/store/scan.c", "slot + 1u == SLOTS", "slot == SLOTS"),
    Defect("kernel", "write", "firmware/flash_kernel/requests.c", "> KERNEL_WORDS_MAX", "> 2u * KERNEL_WORDS_MAX"),
    Defect(
        "selftest",
        "hal_selftest_ram",
        "firmware/board/selftest.c",
        "selftest.pair < HAL_SELFTEST_PAIRS &&",
        "selftest.pair <= HAL_SELFTEST_PAIRS &&",
    ),
    Defect("results", "agree", "firmware/commissioning/result.c", "qc_sub_sat(a, b)", "(a - b)"),
    Defect("chip", "keep", "hal/f2808/sci.c", "in % HAL_SCI_RECEIVE_RING]", "in % (HAL_SCI_RECEIVE_RING + 1u)]"),
    Defect("left", "q_shl_sat", "hal/qmath/qarith.h", "(x > q_shr(INT32_MAX, n))", "(x >= q_shr(INT32_MAX, n))"),
    Defect("rest", "q_follow_remainder", "hal/qmath/qarith.h", "(int32_t)(sum >> n)", "(int32_t)(sum >> (n - 1u))"),
    Defect("devices", "bit_of", "hal/f2808/can.c", "(31u - q_clz32(pending))", "(32u - q_clz32(pending))"),
    Defect("contracts", "q_clamp", "hal/qmath/qarith.h", "return (x > hi) ? hi : x;", "return (x >= hi) ? lo : x;"),
    Defect("contracts", "q_sat64", "hal/qmath/qarith.h", "(x < 0) ? INT32_MIN : INT32_MAX", "INT32_MAX"),
    Defect("contracts", "q15_sat", "hal/qmath/qarith.h", "q_clamp(x, INT16_MIN, ", "q_clamp(x, -INT16_MAX, "),
    Defect(
        "contracts", "q_mul_hi", "hal/qmath/qarith.h", "q_shr64(q_product(a, b), 32)", "q_shr64((int32_t)a * b, 32)"
    ),
    Defect("contracts", "q_sub_sat", "hal/qmath/qarith.h", "q_sat64((int64_t)a - b)", "a - b"),
    Defect(
        "contracts", "q_abs_u32", "hal/qmath/qarith.h", "((uint32_t)0 - (uint32_t)x)", "((uint32_t)1 - (uint32_t)x)"
    ),
    Defect("contracts", "q_over", "hal/qmath/qdiv.h", "inverse.exponent - shift", "inverse.exponent - 1u - shift"),
)
