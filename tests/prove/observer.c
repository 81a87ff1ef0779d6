// The deviation observer with any windows, any torque and any tuning, step after step, from any angle, speed and load.

#include "tests/prove/any_observer.h"
#include "tests/prove/any_windows.h"

static surroundings_t around;

static deviation_observer_config_t any_tuning(void) {
  any_model(&around.model);
  return any_observer(&around.model);
}

static void look_back(deviation_observer_t* s) {
  dq_t residual_q20;
  int32_t span_ticks;
  int32_t periods;
  (void)deviation_observer_take_left(s, &residual_q20, &span_ticks, &periods);
}

void prove_observer(void) {
  static deviation_observer_t s;
  deviation_observer_config_t c = any_tuning();
  deviation_observer_preset(&s, any_u32, any_speed(), any_i32);
  while (any_bool()) {
    if (any_bool()) c = any_tuning();
    if (any_bool()) deviation_observer_stands(&s);
    if (any_bool()) deviation_observer_learn(&s, &c);
    if (any_bool()) look_back(&s);
    (void)deviation_observer_is_due(&s);
    for (uint16_t count = 0; count <= ESTIMATOR_WINDOWS; count++) {
      const estimator_input_t in = any_input(&around, 0, count);
      if (any_bool()) (void)deviation_observer_step(&s, &c, &in);
    }
    //@ assert -1298773986 <= s.speed_bpp <= 1298773986;
    //@ assert 16 <= s.p_aa <= 536870912 && 16 <= s.p_ss <= 536870912 && 16 <= s.p_ll <= 536870912;
    //@ assert 0 <= s.gathered.periods <= 12;
    //@ assert -536870912 <= s.p_as <= 536870912;
    //@ assert -536870912 <= s.p_al <= 536870912;
    //@ assert -536870912 <= s.p_sl <= 536870912;
  }
}
