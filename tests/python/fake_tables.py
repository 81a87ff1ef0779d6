"""What the fake drive has: parameters, signals, words, the numbers of the protocol, how it refuses."""

# id, name, unit, q, decimals, minimum, maximum, initial, always, meaning; values in the unit
PARAMETERS = [
    (1, "motor_poles", "", 0, 0, 1, 20, 4, False, "pole pairs"),
    (10, "current_scale", "", 0, 0, -6, 6, 0, False, "power of two of the currents' ranges"),
    (6, "current_limit", "A", 20, 2, 0.1, 16, 14, True, "largest current"),
    (8, "speed_limit", "rpm", 8, 0, 100, 4000, 3300, False, "largest speed"),
    (86, "speed_ramp", "rpm/s", 8, 0, 0, 100000, 3000, True, "slope of the speed reference, 0 for a step"),
    (164, "link_regulation", "V", 16, 1, 10, 450, 405, True, "DC link from which braking is reduced"),
    (200, "link_timeout", "ms", 0, 0, 50, 10000, 300, True, "silence after which a guarded drive stops"),
    (101, "ratio", "%", 16, 2, -50, 50, 0, True, ""),
]
SIGNALS = [
    ("state", "", 0, "state of the drive"),
    ("angle", "turn", 32, "electrical angle"),
    ("speed", "rpm", 16, "mechanical speed"),
    ("speed_known", "", 0, "1: known, 0: unknown"),
    ("speed_reference", "rpm", 16, "speed reference after the ramp"),
    ("current_d", "A", 20, "measured d-axis current"),
    ("current_q", "A", 20, "measured q-axis current"),
    ("link_voltage", "V", 16, "DC-link voltage"),
]
ROTOR = {"angle", "speed", "current_d", "current_q"}
"""What is known only with the rotor's angle."""
STATES = ["boot", "calibrate", "ready", "start", "run", "stop", "fault", "commission"]
WORDS = {
    0: STATES,
    1: ["none", "over-current: the comparator opened the gates", "a phase current beyond trip_current"],
    2: ["current", "voltage", "weakening"],
    3: ["used", "too few samples"],
    4: ["idle", "turning", "staircase"],
    5: ["empty", "loaded", "damaged", "migrated", "saving", "saved", "failed"],
    10: ["idle", "filling", "armed", "triggered", "done"],
}
CONFLICT_WORDS = "link_regulation must be above link_minimum"
OK, UNKNOWN, RANGE, RUNNING, LENGTH, BUSY, STATE, CONFLICT = range(8)
READY, RUN, STOP, FAULT, COMMISSION = 2, 4, 5, 6, 7


class RefusalError(Exception):
    def __init__(self, status, text=""):
        self.status, self.text = status, text


def raw(value, q):
    return round(value * 2**q)
