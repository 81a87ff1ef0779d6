"""The parts of the drive's C that Frama-C reads together: files, options, and what is taken for granted in them."""

from proof.part import LINK_RANGES, QMATH, RANGES, eva, of_link, of_qmath, with_contract, wp

CONTRACTS = "tests/prove/qmath_contracts.h"
SHIFT_RANGES, BITS, FLOOR = "tests/prove/shift_ranges.h", "tests/prove/bits.h", "tests/prove/floor.h"
OVER, LEFT_SHIFT, REST = (f"tests/prove/{name}.h" for name in ("over_contract", "left_shift", "rest"))
LAYOUT_RANGES = "tests/prove/svpwm_ranges.h"
ROTATION_RANGES = "tests/prove/rotation_ranges.h"
CONTROL_RANGES, MODULATOR_RANGES = "tests/prove/control_ranges.h", "tests/prove/modulator_ranges.h"
ESTIMATORS_RANGES, START_RANGES = "tests/prove/estimators_ranges.h", "tests/prove/start_ranges.h"
LOOK_RANGES, RESULTS_RANGES = "tests/prove/look_ranges.h", "tests/prove/results_ranges.h"
FLOORS = (CONTROL_RANGES, MODULATOR_RANGES, ESTIMATORS_RANGES, START_RANGES)


# Read with any argument by itself; what calls it is read with its contract (qmath_ranges.h and the others).
OF_QMATH = "q_clz32,q_reciprocal_q31,q_div,q_invert,q_sqrt64,q_sqrt32,q_hypot,q_atan2,q_sincos,q_limit"
OF_QMATH += ",q_follow,q_follow_near,q_follow_halves,q_follow_remainder,q_gather,q_mix,q_mix_sat,q_square,q_square_sat"
OF_LAYOUTS = "svpwm_alternating_fits,svpwm_alternating,svpwm_extended,svpwm_cheapest_pair,svpwm_centred,svpwm_long_zero"
OF_BLOCKS = "crc16,cobs_encode,cobs_decode"
OF_WRITING = (
    "put_text,put_unsigned,put_fixed,put_spaces_to,put_message,put_packed,packed_is_empty,packed_reader,packed_next"
)
OF_DECIMALS = "text_number,decimal_raw,decimal_is_whole"
OF_TYPING = f"{OF_DECIMALS},packed_occurs,packed_find,packed_equals,suggest_is_near"
EVERY_TEXT = ("packed_before", "packed_middle", "packed_behind")
OF_LINES = "editor_octet,editor_next,editor_show"
OF_RECORDS = "splitter_octet,splitter_rest,record_to_wire"
OF_FRAMES = "segment_join,segment_split_begin,segment_split_peek,segment_split_advance"
CONTRACTS_OF_QMATH = (
    *("q_shr", "q_shr64", "q_max", "q_min", "q_max16", "q_min16", "q_clamp", "q_in_range", "q_sat64"),
    *("q_add_sat", "q_sub_sat", "q_neg_sat", "q_abs_sat", "q_product", "q_mul64", "q_mul", "q_mul_sat", "q_mac"),
    *("q_abs_u32", "q_mul_add_sat", "q_mul_sub_sat", "q_share_q30", "q_over"),
    *("q_mul_add", "q_mul_sub", "q_mul_floor", "q_mul_add_floor", "q_mul_sub_floor", "q_mul_hi", "q_umul_hi"),
    *("q15_sat", "q15_add_sat", "q15_sub_sat", "q15_mul"),
)
BETWEEN = ("q_shr_round", "q_sat64", "q_limit", "q_follow", "q_follow_near", "q_follow_halves")
PULSES = "svpwm_put_pulse,layout_for,most_of_both,longest_window,lay_out,own_zero,advance"
PULSES += ",put_pair_first,put_pair_last,alternate,modulator_step"
CONTRACTS_OF_LAYOUTS = tuple(f"{PULSES},{OF_LAYOUTS}".split(","))
INLINED = "svpwm_fall_of,svpwm_put_order,put_nested_order,put_centred"
# Intervals do not see in their code what these promise, and where EVA reads it the promise is taken. The part limits
# shows that of q_sat_bits slice by slice; at q_mix and q_mix_sat the prover stops, and tests/qmath tries every edge.
SHOWN_ELSEWHERE = ("q_sat_bits", "q_mix", "q_mix_sat")

# Of what the build makes (toolchain/compose.py).
SOURCES_TABLE, VARIANTS_TABLE = "made/position_sources.c", "made/source_variants.c"
START_SOURCE, DEFAULT_SOURCE = "made/start_source.c", "made/default_source.c"
SVPWM = ("tests/prove/svpwm.c", "svpwm/*.c", QMATH)
CONTROL = ("control/*.c", QMATH)
ESTIMATORS = ("estimators/*.c", *CONTROL)
CONFIGURATION = (
    *(
        "tests/prove/configuration.c",
        "firmware/config/config.c",
        "firmware/mode/source.c",
        "firmware/dictionary/parameters.c",
        "firmware/config/rules.c",
        "firmware/base/clear.c",
    ),
    *("firmware/sources/*/*.c", "firmware/start/if_start/load.c"),
    *(SOURCES_TABLE, VARIANTS_TABLE, DEFAULT_SOURCE, "svpwm/*.c", *ESTIMATORS),
)
OCTETS, RECORD, CRC = "firmware/base/octets.c", "firmware/link/record.c", "firmware/base/crc.c"
CRC_BLOCK = "firmware/base/crc_block.c"
FRAMES = (
    *("tests/prove/framing.c", "firmware/link/splitter.c", RECORD, "firmware/link/cobs.c", CRC),
    *("firmware/can/segments.c", "hal/qmath/qdiv.c"),
)
LOOKS = (
    "made/signal_looks.c",
    *(f"firmware/{at}/signals.c" for at in ("board", "sources/flux", "sources/observer", "start", "start/flying")),
)
TEXTS = (
    *(
        "firmware/text/text.c",
        "firmware/text/catalogue.c",
        "firmware/text/packed_text.c",
        "firmware/dictionary/parameters.c",
        "firmware/dictionary/units.c",
        "firmware/drive/signals.c",
        *LOOKS,
    ),
    *(OCTETS, "hal/qmath/qcall.c", "hal/qmath/qdiv.c", "hal/qmath/qquotient.c"),
)
TYPED = ("tests/prove/text.c", "firmware/console/suggest/suggest.c", *TEXTS)
BESIDE = (
    *("tests/prove/any_drive.c", "firmware/api/actions.c", "firmware/mode/fault_history.c", "firmware/scope/scope.c"),
    *(
        "firmware/api/comm_watchdog.c",
        "firmware/api/status.c",
        "firmware/mode/access.c",
        "firmware/link/stream.c",
        *TEXTS,
    ),
    *("firmware/store/actions.c", "firmware/commissioning/actions.c"),
)
TERMINAL = tuple(f"firmware/console/{name}.c" for name in ("console", "job", "editor", "output"))

STORE = (
    *("tests/prove/store.c", "firmware/dictionary/parameters.c", "firmware/text/text.c", "firmware/api/status.c"),
    *(OCTETS, CRC, CRC_BLOCK),
    *("hal/qmath/qcall.c", "hal/qmath/qdiv.c", "hal/qmath/qquotient.c"),
    *(f"firmware/store/{name}.c" for name in ("reader", "scan", "slot", "store", "values", "writer")),
)
KERNEL = (
    *("tests/prove/kernel.c", "firmware/flash_kernel/*.c", "firmware/link/splitter.c", RECORD, OCTETS, CRC),
    "hal/qmath/qdiv.c",
)
SELFTEST = (
    *("tests/prove/selftest.c", "firmware/board/selftest.c", "firmware/board/flash_sum.c", "firmware/base/clear.c"),
    *("firmware/dictionary/parameters.c", "firmware/text/text.c", OCTETS, CRC),
    *("hal/qmath/qcall.c", "hal/qmath/qdiv.c", "hal/qmath/qquotient.c"),
)

RESULTS = (
    *("tests/prove/results.c", "firmware/commissioning/solve.c", "firmware/commissioning/result.c"),
    *(
        "firmware/dictionary/parameters.c",
        "firmware/text/text.c",
        OCTETS,
        "firmware/mode/access.c",
        "estimators/inverse_inductance_tensor.c",
        "estimators/fit.c",
    ),
    *CONTROL,
)

DRIVERS = (
    *("adc", "clock", "digital_io", "encoder", "gpio", "irq"),
    *("pwm", "safety", "sampling_timer", "sci", "timer", "watchdog"),
)
ANY_REGISTER = "tests/prove/any_register.c"
CHIP = ("tests/prove/chip.c", ANY_REGISTER, "hal/qmath/qdiv.c", *(f"hal/f2808/{name}.c" for name in DRIVERS))
OF_DEVICES = "can", "i2c", "eeprom", "selftest", "flash", "flash_read", "gpio"
DEVICES = ("tests/prove/devices.c", ANY_REGISTER, "hal/qmath/qdiv.c", *(f"hal/f2808/{name}.c" for name in OF_DEVICES))

# All that the control interrupt runs but what speaks to the chip; and what of that is read by itself.
INTERRUPT = (
    *("tests/prove/interrupt.c", "firmware/start/*.c", "firmware/start/*/*.c", "firmware/scope/scope.c"),
    *(*ESTIMATORS, "svpwm/*.c"),
    *("firmware/drive/*.c", "firmware/mode/*.c", "firmware/sources/*/*.c", "firmware/hysteresis/*.c"),
    *(SOURCES_TABLE, START_SOURCE, DEFAULT_SOURCE, "made/drive_states.c", "made/start_phases.c"),
    *("made/signal_looks.c", "firmware/board/signals.c"),
    *(f"firmware/board/{name}.c" for name in ("derating", "functions", "speed_input")),
    *(f"firmware/commissioning/{name}.c" for name in ("sequence", "hold", "map", "spin", "staircase")),
)


READER = ("-eva-auto-loop-unroll", "12", "-eva-slevel", "20", "-eva-split-return", "auto")
# As many iterations of a loop, each by itself, and as many ways into a function kept apart.
APART = (
    *("-eva-auto-loop-unroll", "40", "-eva-slevel", "100"),
    *("-eva-partition-history", "2", "-eva-interprocedural-history"),
)
WHOLE = ("-eva-auto-loop-unroll", "12", "-eva-widening-delay", "8")
NUMBERS = (
    *("-eva-min-loop-unroll", "130", "-eva-slevel", "12", "-eva-split-return", "auto"),
    *("-eva-slevel-function", "put_digits:60,put_spaces_to:300"),
)
NAMES = (
    *("-eva-min-loop-unroll", "250", "-eva-slevel", "4", "-eva-split-return", "auto"),
    *("-eva-slevel-function", "suggest_is_near:400"),
)
ROUNDS = ("-eva-auto-loop-unroll", "40", "-eva-slevel", "20", "-eva-split-return", "full")


PARTS = (
    *(of_qmath(name) for name in ("arithmetic", "limits", "quotients", "roots", "vectors", "angles")),
    of_qmath("lengths", (), "q_sqrt64"),
    eva(
        "svpwm",
        SVPWM,
        READER,
        f"{OF_QMATH},{OF_LAYOUTS}",
        headers=(LAYOUT_RANGES, MODULATOR_RANGES),
    ),
    *(
        wp(
            name,
            ("tests/prove/layouts.c",),
            ("-inline-calls", INLINED, "-wp-timeout", "120", "-wp-par", "1", *flags),
            proved,
            (CONTRACTS, LAYOUT_RANGES),
        )
        # Leg by leg it is a third of the work at the one, and twice as much at the others.
        for name, proved, flags in (
            ("layouts", CONTRACTS_OF_LAYOUTS, ()),
            ("alternating", ("lengths_with",), ("-wp-split",)),
        )
    ),
    eva(
        "edges",
        SVPWM,
        ("-eva-min-loop-unroll", "6", "-eva-slevel", "60"),
        OF_QMATH,
        headers=(MODULATOR_RANGES,),
    ),
    eva(
        "control",
        ("tests/prove/control.c", *CONTROL),
        (*READER, "-eva-subdivide-non-linear", "20"),
        OF_QMATH,
        headers=(CONTROL_RANGES,),
    ),
    *(
        eva(
            name,
            (f"tests/prove/{name}.c", *sources),
            (*READER, *rounds, "-eva-slevel-function", "information_collect:100,look:100"),
            f"{OF_QMATH},turned{given}",
            headers=(ROTATION_RANGES, *headers),
        )
        for name, sources, given, headers, rounds in (
            ("estimators", ESTIMATORS, "", (ESTIMATORS_RANGES,), ()),
            ("look", ("estimators/deviation.c", "estimators/regression.c", *CONTROL), "", (LOOK_RANGES,), ()),
            # An observer begins with nothing, word by word.
            ("observer", ESTIMATORS, ",look", (LOOK_RANGES, ESTIMATORS_RANGES), ("-eva-auto-loop-unroll", "64")),
        )
    ),
    *(
        eva(name, (f"tests/prove/{name}.c", *ESTIMATORS), READER, OF_QMATH, headers=(header,))
        for name, header in (("flux", ESTIMATORS_RANGES), ("start", START_RANGES))
    ),
    eva(
        "turned",
        ("tests/prove/turned.c", "control/*.c", QMATH),
        ("-eva-slevel", "40", "-eva-auto-loop-unroll", "12"),
        headers=(ROTATION_RANGES,),
    ),
    eva(
        "commissioning",
        ("tests/prove/start.c", *ESTIMATORS),
        (*ROUNDS, "-eva-min-loop-unroll", "70"),
        OF_QMATH,
        headers=(START_RANGES,),
    ),
    eva(
        "interrupt",
        INTERRUPT,
        (*WHOLE, "-eva-slevel-function", "follow_link:20,drive_read_samples:20"),
        f"{OF_QMATH},turned,{with_contract(*FLOORS)}",
        headers=(ROTATION_RANGES, *FLOORS),
    ),
    # A constant that does not fit its word would be another number, silently.
    eva("configuration", CONFIGURATION, (*READER, "-warn-signed-downcast"), f"{OF_QMATH},q_sat64,q_sat_bits"),
    # More rounds than there are texts. Results of one long walk cost half.
    *(of_link(third, TYPED, ("-eva-min-loop-unroll", "1200", "-eva-no-results")) for third in EVERY_TEXT),
    of_link("numbers", TYPED, NUMBERS, OF_QMATH, "put_packed"),
    of_link("names", TYPED, NAMES, OF_QMATH, "packed_reader,packed_next"),
    of_link("near", TYPED, NAMES, OF_QMATH, "packed_occurs,packed_reader,packed_next,packed_rest_is"),
    of_link(
        "editor",
        ("tests/prove/editor.c", "firmware/console/editor.c", OCTETS, "hal/qmath/qdiv.c"),
        ("-eva-slevel", "20", "-eva-auto-loop-unroll", "10"),
        "put_text",
    ),
    of_link(
        "commands",
        (
            *("tests/prove/commands.c", *TERMINAL, *BESIDE),
            *(f"firmware/console/{name}.c" for name in ("command*", "names", "words_of_line", "s*", "suggest/suggest")),
            *(f"firmware/{folder}/commands.c" for folder in ("can", "scope", "start/flying", "store", "commissioning")),
            *("firmware/link/status.c", "firmware/scope/commands_*.c"),
        ),
        READER,
        *(OF_QMATH, "q_shl_sat", OF_WRITING, OF_TYPING, OF_LINES, "unit_exponent"),
        related=("number_with_unit", "words_from"),
    ),
    wp(
        "words",
        ("tests/prove/words.c",),
        ("-wp-timeout", "60"),
        ("number_with_unit", "words_from", "command_set"),
        (LINK_RANGES,),
    ),
    of_link(
        "requests",
        (
            *("tests/prove/requests.c", "firmware/link/requests*.c", CRC, CRC_BLOCK),
            *(f"firmware/{folder}/requests.c" for folder in ("scope", "store", "commissioning")),
            *("firmware/hil/*.c", "firmware/base/clear.c", "hal/replay.c", *BESIDE),
        ),
        # A row says how long its bodies are; rows of what the scope watches and of the signals go step by step.
        (
            *(*READER, "-eva-split-return-function", "find:full"),
            *("-eva-slevel-function", "find:100,handle:100,drive_signals:300,record:20"),
        ),
        *(OF_QMATH, OF_WRITING, "packed_equals,packed_find,unit_exponent"),
    ),
    of_link(
        "console",
        ("tests/prove/console.c", "firmware/link/link.c", "firmware/link/splitter.c", RECORD, *TERMINAL, *BESIDE),
        (*ROUNDS, "-eva-slevel-function", "stream_event:300"),
        *(OF_QMATH, OF_WRITING, OF_LINES, OF_RECORDS),
    ),
    of_link(
        "node",
        (
            *("tests/prove/node.c", RECORD, *BESIDE),
            *(f"firmware/can/{name}.c" for name in ("command", "messages", "node", "segments", "telemetry")),
        ),
        (*ROUNDS, "-eva-slevel-function", "stream_event:300"),
        *(OF_QMATH, OF_WRITING, OF_FRAMES, "packed_equals", "unit_exponent"),
    ),
    of_link("blocks", FRAMES, ("-eva-auto-loop-unroll", "300")),
    of_link("framing", FRAMES, APART, OF_BLOCKS),
    of_link("store", STORE, READER, *(OF_QMATH, "q_shl_sat")),
    of_link("kernel", KERNEL, ROUNDS, *(OF_QMATH, OF_RECORDS)),
    of_link("selftest", SELFTEST, ("-eva-auto-loop-unroll", "16", "-eva-slevel", "20"), *(OF_QMATH, OF_WRITING)),
    eva(
        "results",
        RESULTS,
        ("-eva-auto-loop-unroll", "140", "-eva-slevel", "20", "-eva-split-return", "full"),
        f"{OF_QMATH},fit_ratio",
        headers=(RESULTS_RANGES,),
    ),
    # What is volatile has any bits, also where it is a truth value.
    of_link("chip", CHIP, ("-eva-auto-loop-unroll", "140", "-no-warn-invalid-bool"), OF_QMATH),
    of_link("devices", DEVICES, ("-eva-auto-loop-unroll", "140", "-no-warn-invalid-bool"), OF_QMATH),
    *(
        wp(name, ("hal/qmath/qdiv.c",), ("-wp-timeout", "20"), proved, headers)
        for name, proved, headers in (
            ("contracts", CONTRACTS_OF_QMATH, (BITS, CONTRACTS, OVER)),
            ("shifts", ("q_shr",), (BITS, CONTRACTS, FLOOR, SHIFT_RANGES)),
            ("left", ("q_shr", "q_shl_sat"), (CONTRACTS, FLOOR, LEFT_SHIFT)),
            ("rest", ("q_follow_remainder",), (REST, SHIFT_RANGES, RANGES)),
            ("between", BETWEEN, (BITS, CONTRACTS, SHIFT_RANGES, RANGES)),
        )
    ),
)
# What takes longest begins first: nobody waits for it alone at the end.
LONGEST = ("layouts", *EVERY_TEXT, "interrupt", "requests", "numbers")
PROVED = frozenset(function for part in PARTS for function in part.proved)
