#include "firmware/words.h"

#include <stddef.h>

#include "firmware/store/store.h"

static const char* const states[] = {
    "boot", "calibrating the current offsets", "ready", "starting", "running", "stopping", "fault", "commissioning"};

#define FAULT(number, name, words, remedy) words,
static const char* const faults[] = {
#include "firmware/fault_list.h"
};
#undef FAULT

#define FAULT(number, name, words, remedy) remedy,
static const char* const remedies[] = {
#include "firmware/fault_list.h"
};
#undef FAULT

static const char* const limits[] = {"current limit", "voltage limit", "field weakening", "control interrupt late",
                                     "braking reduced by the DC link"};

static const char* const verdicts[] = {
    "plausible, in use",
    "not measured: too few usable periods, or the current did not reach its level",
    "the points scatter too much around the fitted line: current too small, shaft not at rest, or a loose contact",
    "too far from the value given before: check nameplate, connection and current range",
    "two ways of measuring it disagree: load on the shaft, or a wrong pole pair number",
    "outside of the parameter's range",
    "no machine has this: check the order of the phases and the current sensors",
    "rests on another value that was refused"};

static const char* const phases[] = {"offsets, axis and polarity",
                                     "turning to a favourable angle",
                                     "DC staircase: resistance, drop, dead time",
                                     "spin: flux linkage, inertia, friction",
                                     "inductances under torque current",
                                     "evaluation"};

static const char* const statuses[] = {
    "done",
    "there is no such thing",
    "outside of its range",
    "not while the power stage is on",
    "the record has a wrong length",
    "busy, ask again",
    "not in this state of the drive",
    "the parameters do not fit together",
};

static const char* const starts[] = {"listening whether the shaft turns",
                                     "short circuit, to see the back-EMF",
                                     "catching a turning shaft",
                                     "finding the axis",
                                     "settling the current loop",
                                     "polarity by saturation",
                                     "polarity by motion"};

static const char* const outcomes[] = {"not yet",
                                       "under way",
                                       "complete",
                                       "done in part, the rest keeps its old value",
                                       "stopped by command, or the shaft turned and had to be brought to rest",
                                       "ended by a fault"};

static const char* const scopes[] = {"idle", "filling", "armed", "triggered", "done"};

static const char* const buses[] = {"off",
                                    "waiting for the bus",
                                    "on the bus",
                                    "on the bus, with many errors",
                                    "on the bus, error passive: nobody acknowledges, or its rate is another",
                                    "bus-off: it tries again after can_recovery"};

#define LIST(list) {(list), (uint16_t)(sizeof(list) / sizeof((list)[0]))}

static const struct {
  const char* const* words;
  uint16_t count;
} kinds[WORDS_KINDS] = {LIST(states),   LIST(faults), LIST(limits),   LIST(verdicts), LIST(phases), {NULL, 0},
                        LIST(statuses), LIST(starts), LIST(remedies), LIST(outcomes), LIST(scopes), LIST(buses)};

const char* words_or_null(uint16_t kind, uint16_t code) {
  if (kind == WORDS_STORE) return (code <= STORE_OLDER) ? store_words((store_state_t)code) : NULL;
  return (kind < WORDS_KINDS && code < kinds[kind].count) ? kinds[kind].words[code] : NULL;
}

const char* words(words_kind_t kind, uint16_t code) {
  const char* const found = words_or_null((uint16_t)kind, code);
  return (found != NULL) ? found : "?";
}
