// The layouts of a period with any on-times, by relations and not by intervals: WP proves that no edge leaves the room
// that there is for them, and that the edges are those of three pulses. svpwm_ranges.h says what is taken of that.

#include "svpwm/alternating.c"
#include "svpwm/extended.c"
#include "svpwm/modulator.c"

// What the on-times of the legs are to each other (svpwm/on_time.h): tests/svpwm tries it with any voltage and link.
#define SPREAD (SVPWM_SPREAD_MAX_TICKS + 1)
#define LONGEST (SVPWM_LAST_TICK - SVPWM_FIRST_TICK)
#define LEGS(t) legs_of((t).hi, (t).mid, (t).lo)
#define ON_TIME(t, k) (-SPREAD <= (t).leg[k] <= SPREAD && (t).leg[(t).lo] <= (t).leg[k] <= (t).leg[(t).hi])
#define ON_TIMES(t)                                                                                     \
  (LEGS(t) && ON_TIME(t, 0) && ON_TIME(t, 1) && ON_TIME(t, 2) && (t).leg[(t).lo] <= (t).leg[(t).mid] && \
   (t).leg[(t).mid] <= (t).leg[(t).hi] && (t).leg[(t).hi] - (t).leg[(t).lo] <= SPREAD)
#define GIVEN(t) (\valid_read(t) && ON_TIMES(*(t)))
#define IS_PULSE(ticks) (1500 <= (ticks) <= 4700)
#define FITS(t, ticks) (10 * ((t)->leg[(t)->hi] - (t)->leg[(t)->lo]) < 7 * (ticks))

/*@ predicate legs_of(integer a, integer b, integer c) = (a == 0 && b == 1 && c == 2) || (a == 0 && b == 2 && c == 1) ||
      (a == 1 && b == 0 && c == 2) || (a == 1 && b == 2 && c == 0) || (a == 2 && b == 0 && c == 1) ||
      (a == 2 && b == 1 && c == 0);

    predicate pulse(svpwm_pulses_t* p, integer leg) =
      SVPWM_FIRST_TICK <= p->at[leg] < p->at[leg + 3] <= SVPWM_LAST_TICK;

    predicate in_room(svpwm_pulses_t* p) = pulse(p, 0) && pulse(p, 1) && pulse(p, 2);

    predicate is(svpwm_pulses_t* p, integer leg, integer rise, integer on) =
      p->at[leg] == rise && p->at[leg + 3] == rise + on;

    predicate extended(extended_config_t* c) = \valid_read(c) &&
      500 <= c->window_min_ticks <= c->window_max_ticks <= 4000 && 0 <= c->zero_ticks <= 5000;

    predicate spread(integer t1, integer t2) = 0 <= t1 && 0 <= t2 && t1 + t2 <= SPREAD;

    logic integer larger(integer a, integer b) = a > b ? a : b;
*/

/*@ requires \valid(p) && leg <= 2 && 0 <= rise <= SVPWM_LAST_TICK && 0 <= on <= SVPWM_LAST_TICK;
    assigns p->at[leg], p->at[leg + 3]; ensures is(p, leg, rise, on) && LEG_WRITTEN(p, leg); */
static inline void svpwm_put_pulse(svpwm_pulses_t* p, uint16_t leg, int32_t rise, int32_t on);

/*@ requires spread(t1, t2) && 0 <= window1 <= LONGEST && 0 <= window2 <= LONGEST; assigns \nothing;
    ensures \result.first == larger(t1, window1) && \result.second == larger(t2, window2);
    ensures \result.low_on == larger(SVPWM_PULSE_MIN_TICKS,
      \result.second - t2 + larger(0, \result.first - t1)); */
static layout_t layout_for(int32_t t1, int32_t t2, int32_t window1, int32_t window2);

/*@ requires spread(t1, t2) && 0 <= room <= SVPWM_ROOM_TICKS; assigns \nothing;
    ensures \result <= room - SVPWM_PULSE_MIN_TICKS && 2 * \result <= room + t1 + t2;
    ensures \result == room - SVPWM_PULSE_MIN_TICKS || 2 * \result >= room + t1 + t2 - 1; */
static int32_t most_of_both(int32_t t1, int32_t t2, int32_t room);

/*@ requires spread(t1, t2) && 0 <= room <= SVPWM_ROOM_TICKS && extended(c); assigns \nothing;
    ensures \result == 0 || c->window_min_ticks <= \result <= c->window_max_ticks;
    ensures \result > 0 ==> larger(t1, \result) + larger(t2, \result) <= room - SVPWM_PULSE_MIN_TICKS;
    ensures \result > 0 ==> 2 * (larger(t1, \result) + larger(t2, \result)) <= room + t1 + t2; */
static int32_t longest_window(int32_t t1, int32_t t2, int32_t room, const extended_config_t* c);

/*@ requires \valid_read(t) && \valid_read(l) && \valid(pulses) && \separated(pulses, t, l) && LEGS(*t);
    requires spread(t1, t2) && 0 <= l->first && 0 <= l->second && 1 <= l->low_on;
    requires l->first + l->second + l->low_on <= LONGEST && l->first + t2 + l->low_on <= LONGEST;
    requires t1 + t2 + l->low_on <= LONGEST;
    assigns *pulses; ensures is(pulses, t->hi, SVPWM_FIRST_TICK, t1 + t2 + l->low_on);
    ensures is(pulses, t->mid, SVPWM_FIRST_TICK + l->first, t2 + l->low_on);
    ensures is(pulses, t->lo, SVPWM_FIRST_TICK + l->first + l->second, l->low_on);
    ensures in_room(pulses);
    ensures WRITTEN(pulses) && OF_ORDER(pulses->order); */
static void lay_out(const svpwm_on_time_t* t, int32_t t1, int32_t t2, const layout_t* l, svpwm_pulses_t* pulses);

/*@ requires extended(c) && GIVEN(t) && \valid(pulses) && \separated(pulses, t, c);
    ensures in_room(pulses); */
void svpwm_extended(const extended_config_t* c, const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/*@ requires spread(t1, t2); assigns \nothing;
    ensures \result == SVPWM_PERIOD_TICKS - SVPWM_FIRST_TICK - SVPWM_PULSE_MIN_TICKS - t1 - t2; */
static int32_t own_zero(int32_t t1, int32_t t2);

/*@ requires extended(c) && GIVEN(t) && \valid(pulses) && \separated(pulses, t, c);
    ensures in_room(pulses); */
void svpwm_cheapest_pair(const extended_config_t* c, const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/*@ requires GIVEN(t) && \valid(pulses) && \separated(pulses, t); ensures in_room(pulses); */
void svpwm_centred(const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/*@ requires GIVEN(t) && \valid(pulses) && \separated(pulses, t); ensures in_room(pulses); */
void svpwm_long_zero(const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/*@ requires GIVEN(t) && 0 <= pulse_ticks <= 4700;
    ensures \result != 0 <==> FITS(t, pulse_ticks); */
static inline bool svpwm_alternating_fits(const svpwm_on_time_t* t, int16_t pulse_ticks);

/*@ predicate lengths(lengths_t* l) = \valid_read(l) && legs_of(l->x, l->longer, l->shorter) &&
      1 <= l->on_x <= LONGEST && 1 <= l->on_longer <= LONGEST && 1 <= l->on_shorter <= LONGEST; */

/*@ requires \valid(p) && lengths(l) && \separated(p, l); assigns p->at[0 .. 5], p->order[0 .. 5];
    ensures in_room(p) && WRITTEN(p) && OF_ORDER(p->order); */
static void put_pair_first(svpwm_pulses_t* p, const lengths_t* l);

/*@ requires \valid(p) && lengths(l) && \separated(p, l); assigns p->at[0 .. 5], p->order[0 .. 5];
    ensures in_room(p) && WRITTEN(p) && OF_ORDER(p->order); */
static void put_pair_last(svpwm_pulses_t* p, const lengths_t* l);

/*@ requires GIVEN(t) && (x == t->hi || x == t->mid || x == t->lo) && IS_PULSE(pulse_ticks);
    requires FITS(t, pulse_ticks); assigns \nothing;
    ensures legs_of(\result.x, \result.longer, \result.shorter) && \result.x == x;
    ensures 1 <= \result.on_x <= LONGEST && 1 <= \result.on_longer <= LONGEST && 1 <= \result.on_shorter <= LONGEST; */
static lengths_t lengths_with(uint16_t x, const svpwm_on_time_t* t, int16_t pulse_ticks);

/*@ requires \valid(s) && s->leg <= 2; assigns *s; ensures s->leg <= 2 && (s->pair_first == 0 || s->pair_first == 1); */
static void advance(alternating_state_t* s);

/*@ requires \valid(s) && s->leg <= 2 && IS_PULSE(pulse_ticks);
    requires GIVEN(t) && \valid(pulses) && \separated(pulses, t, s);
    requires FITS(t, pulse_ticks); ensures in_room(pulses); */
void svpwm_alternating(alternating_state_t* s, const svpwm_on_time_t* t, int16_t pulse_ticks, svpwm_pulses_t* pulses);

/*@ assigns \nothing; */
static inline int32_t svpwm_ticks_per_volt_q20(int32_t link_q16, int32_t last_q20);

/*@ assigns \nothing; ensures ON_TIMES(\result); */
static inline svpwm_on_time_t svpwm_on_time(ab_t voltage_q16, int32_t ticks_per_volt_q20);

/*@ requires \valid_read(s) && \valid_read(c) && GIVEN(t) && IS_PULSE(c->pulse_ticks);
   assigns \nothing; ensures \result != 0 ==> FITS(t, c->pulse_ticks); */
static bool alternate(const modulator_t* s, const modulator_config_t* c, const svpwm_on_time_t* t);

/*@ requires \valid(s) && \valid_read(c) && \valid(pulses) && \separated(s, c, pulses) && s->alternating.leg <= 2;
    requires extended(&c->extended) && IS_PULSE(c->pulse_ticks); assigns *s, *pulses;
    ensures in_room(pulses) && s->alternating.leg <= 2; */
modulator_result_t modulator_step(modulator_t* s, const modulator_config_t* c, excitation_t excitation,
                                  ab_t voltage_q16, int32_t link_q16, svpwm_pulses_t* pulses);
