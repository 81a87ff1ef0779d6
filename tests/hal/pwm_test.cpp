#include "hal/f2808/registers.h"
#include "hal/hal_pwm.h"
#include "hal/hal_replay.h"
#include "hal/hal_safety.h"
#include "tests/hal/bus.hpp"

namespace stillspin::test {

namespace {
constexpr std::uint16_t kDeadBand = 200;  // 2 us
constexpr std::uint32_t kOverCurrentPin = 1u << 12;

hal_pwm_frame_t frame_of_distinct_values() {
  return hal_pwm_frame_t{{101, 201, 301, 1101, 1201, 1301}, {401, 501, 601}, {1401, 1501, 1601}};
}
}  // namespace

class Pwm : public BusTest {
 protected:
  void SetUp() override { bus.power_all(); }

  std::uint16_t epwm(unsigned module, std::uint32_t offset) { return bus.words[EPWM_BASE(module) + offset]; }
};

TEST_F(Pwm, gates_are_tripped_low_before_pins_are_connected) {
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  for (unsigned leg = 1; leg <= 3; ++leg) {
    const std::size_t action = bus.first_write(EPWM_BASE(leg) + EPWM_TZCTL);
    const std::size_t force = bus.first_write(EPWM_BASE(leg) + EPWM_TZFRC, EPWM_TZFRC_OST_MASK);
    expect_before(action, force, "trip action before the trip");
    expect_before(force, bus.first_write(REG_GPAMUX1), "trip before the pin multiplexer");
    EXPECT_EQ(epwm(leg, EPWM_TZCTL), 0x000Au) << "both outputs forced low; 0 would be high impedance";
  }
  EXPECT_EQ(bus.word32(REG_GPAMUX1), 0x555u) << "GPIO0..5 to ePWM1A..3B and no other pin";
  EXPECT_TRUE(hal_pwm_is_tripped());
  EXPECT_EQ(bus.first_write(EPWM_BASE(1) + EPWM_TZCLR), FakeBus::npos);
}

TEST_F(Pwm, gate_pins_are_not_pulled_up) {
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  EXPECT_EQ(bus.word32(REG_GPAPUD), 0x3Fu) << "a pull-up would fight the board's pull-down, which keeps devices off";
}

TEST_F(Pwm, counters_start_last_and_together) {
  bus.words[REG_PCLKCR0] |= PCLKCR0_TBCLKSYNC_MASK;  // as after a second initialisation
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  const std::size_t stop = bus.first_write(REG_PCLKCR0);
  EXPECT_EQ(bus.steps.at(stop).value & PCLKCR0_TBCLKSYNC_MASK, 0u);
  expect_before(stop, bus.first_write(EPWM_BASE(1) + EPWM_TBCTL), "stopped while being set up");
  EXPECT_EQ(bus.last_write(REG_PCLKCR0), bus.last_write_of_all()) << "TBCLKSYNC is the last write";
  EXPECT_NE(bus.words[REG_PCLKCR0] & PCLKCR0_TBCLKSYNC_MASK, 0u);
  EXPECT_NE(bus.words[REG_PCLKCR0] & PCLKCR0_ADCENCLK_MASK, 0u) << "other clocks are kept";
}

TEST_F(Pwm, time_bases_count_up_to_9999_in_step) {
  for (unsigned module = 1; module <= 6; ++module) bus.words[EPWM_BASE(module) + EPWM_TBCTR] = 77;  // a first life's
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  for (unsigned module = 1; module <= 6; ++module) {
    const std::uint16_t control = epwm(module, EPWM_TBCTL);
    EXPECT_EQ(control & EPWM_TBCTL_CTRMODE_MASK, 0u) << "up";
    EXPECT_EQ(control & (EPWM_TBCTL_HSPCLKDIV_MASK | EPWM_TBCTL_CLKDIV_MASK), 0u) << "10 ns a tick";
    EXPECT_EQ(epwm(module, EPWM_TBPRD), 9999u);
    EXPECT_EQ(epwm(module, EPWM_TBCTR), 0u);
    const bool master = module == 1;
    EXPECT_EQ((control & EPWM_TBCTL_PHSEN_MASK) != 0, !master);
    EXPECT_EQ((control & EPWM_TBCTL_SYNCOSEL_MASK) >> EPWM_TBCTL_SYNCOSEL_LSB, master ? 1u : 0u);
    EXPECT_NE(control & EPWM_TBCTL_PRDLD_MASK, 0u) << "a period that is written counts at once";
    EXPECT_NE(control & EPWM_TBCTL_PHSDIR_MASK, 0u) << "up behind the pulse, too";
    EXPECT_EQ(epwm(module, EPWM_TBPHS_TBPHS), master ? 0u : 2u) << "the pulse is two ticks on its way";
  }
}

TEST_F(Pwm, no_pulse_and_no_burst_at_the_start) {
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  for (unsigned module = 1; module <= 6; ++module) {
    const std::uint32_t base = EPWM_BASE(module);
    EXPECT_EQ(epwm(module, EPWM_CMPA_CMPA), 0xFFFFu);
    EXPECT_EQ(epwm(module, EPWM_CMPB), 0xFFFFu);
    const std::size_t immediate = bus.first_write(base + EPWM_CMPCTL, 0x0050);
    expect_before(immediate, bus.first_write(base + EPWM_CMPA_CMPA), "the active value is set as well");
    EXPECT_EQ(epwm(module, EPWM_CMPCTL), 0u) << "shadow, loaded at zero";
    if (module >= 4) {
      expect_before(bus.last_write(base + EPWM_CMPB), bus.first_write(base + EPWM_ETSEL), "compare before triggers");
    } else {
      expect_before(bus.last_write(base + EPWM_CMPB), bus.first_write(base + EPWM_AQCTLA), "compare before actions");
    }
  }
}

TEST_F(Pwm, legs_are_complementary_with_dead_band) {
  for (unsigned leg = 1; leg <= 3; ++leg) bus.words[EPWM_BASE(leg) + EPWM_AQCTLB] = 0x0FFF;  // a first life's
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  for (unsigned leg = 1; leg <= 3; ++leg) {
    EXPECT_EQ(epwm(leg, EPWM_DBCTL), 0x000Bu) << "active high complementary, both edges, from A";
    EXPECT_EQ(epwm(leg, EPWM_DBRED), kDeadBand);
    EXPECT_EQ(epwm(leg, EPWM_DBFED), kDeadBand);
    EXPECT_EQ(epwm(leg, EPWM_AQCTLA), 0x0121u) << "set on CMPA, clear on CMPB and at zero";
    EXPECT_EQ(epwm(leg, EPWM_AQCTLB), 0u);
  }
}

TEST_F(Pwm, windows_trigger_the_adc_and_the_first_module_interrupts) {
  bus.words[EPWM_BASE(1) + EPWM_ETPS] = 0x0001;  // a first life's
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  EXPECT_EQ(epwm(1, EPWM_ETSEL), 0x0009u) << "interrupt at zero";
  EXPECT_EQ(epwm(1, EPWM_ETPS), 0x0000u) << "not counting before hal_irq_enable";
  for (unsigned module = 4; module <= 6; ++module) {
    EXPECT_EQ(epwm(module, EPWM_ETSEL), 0xEC00u) << "SOCA on CMPA up, SOCB on CMPB up";
    EXPECT_EQ(epwm(module, EPWM_ETPS), 0x1100u) << "each event";
    EXPECT_EQ(epwm(module, EPWM_AQCTLA), 0u);
  }
  EXPECT_EQ(epwm(2, EPWM_ETSEL), 0u);
  EXPECT_EQ(epwm(3, EPWM_ETSEL), 0u);
}

TEST_F(Pwm, dead_band_out_of_range_sets_up_nothing) {
  EXPECT_FALSE(hal_pwm_init(0)) << "no dead band would short the DC link";
  EXPECT_FALSE(hal_pwm_init(1024)) << "the register has 10 bits: 1024 would be 0";
  EXPECT_EQ(bus.count_writes(), 0u);
  EXPECT_TRUE(hal_pwm_init(1));
  EXPECT_TRUE(hal_pwm_init(1023));
}

TEST_F(Pwm, dead_band_changes_only_while_the_gates_are_off) {
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  EXPECT_TRUE(hal_pwm_set_dead_band(300));
  for (unsigned leg = 1; leg <= 3; ++leg) {
    EXPECT_EQ(epwm(leg, EPWM_DBRED), 300u);
    EXPECT_EQ(epwm(leg, EPWM_DBFED), 300u);
  }
  EXPECT_FALSE(hal_pwm_set_dead_band(0));
  EXPECT_FALSE(hal_pwm_set_dead_band(1024));
  ASSERT_TRUE(hal_pwm_gates_on());
  EXPECT_FALSE(hal_pwm_set_dead_band(200));
  EXPECT_EQ(epwm(1, EPWM_DBRED), 300u) << "the old one is kept";
}

TEST_F(Pwm, frame_goes_to_the_compare_registers) {
  const hal_pwm_frame_t frame = frame_of_distinct_values();
  bus.words[EPWM_BASE(1) + EPWM_TBCTR] = 5000;
  ASSERT_TRUE(hal_pwm_write(&frame, 5000)) << "the deadline itself is in time";
  for (unsigned i = 0; i < 3; ++i) {
    EXPECT_EQ(epwm(1 + i, EPWM_CMPA_CMPA), frame.edge_tick[i]);
    EXPECT_EQ(epwm(1 + i, EPWM_CMPB), frame.edge_tick[HAL_PWM_LEGS + i]);
    EXPECT_EQ(epwm(4 + i, EPWM_CMPA_CMPA), frame.burst_start_tick[i]);
    EXPECT_EQ(epwm(4 + i, EPWM_CMPB), frame.burst_end_tick[i]);
  }
  EXPECT_EQ(bus.count_writes(), 12u);
}

TEST_F(Pwm, late_frame_writes_nothing) {
  const hal_pwm_frame_t frame = frame_of_distinct_values();
  bus.words[EPWM_BASE(1) + EPWM_TBCTR] = 5001;
  EXPECT_FALSE(hal_pwm_write(&frame, 5000));
  EXPECT_EQ(bus.count_writes(), 0u);
}

TEST_F(Pwm, frame_of_an_overrun_control_interrupt_writes_nothing) {
  const hal_pwm_frame_t frame = frame_of_distinct_values();
  bus.words[EPWM_BASE(1) + EPWM_ETPS] = 0x0005;  // one period start is waiting for ETFLG to be cleared
  bus.words[EPWM_BASE(1) + EPWM_TBCTR] = 10;     // which is why the counter is low
  EXPECT_FALSE(hal_pwm_write(&frame, 5000));
  EXPECT_EQ(bus.count_writes(), 0u);
  EXPECT_EQ(bus.steps.at(1).address, EPWM_BASE(1) + EPWM_TBCTR) << "time first: a start in between must be seen";
  for (const std::uint16_t waiting : {1, 2, 3}) {
    bus.words[EPWM_BASE(1) + EPWM_ETPS] = static_cast<std::uint16_t>(waiting << EPWM_ETPS_INTCNT_LSB | 1);
    EXPECT_FALSE(hal_pwm_write(&frame, 5000)) << waiting;
  }
  bus.words[EPWM_BASE(1) + EPWM_ETPS] = 0xFFF3;  // everything else of the register
  EXPECT_TRUE(hal_pwm_write(&frame, 5000));
}

// A computer that plays the recording must find the drive as late as it was.
TEST_F(Pwm, a_recording_says_whether_a_frame_was_in_time) {
  const hal_pwm_frame_t frame = frame_of_distinct_values();
  for (const bool in_time : {true, false}) {
    hal_replay_start(REPLAY_RECORDS, nullptr);
    bus.words[EPWM_BASE(1) + EPWM_TBCTR] = in_time ? 5000 : 5001;
    EXPECT_EQ(hal_pwm_write(&frame, 5000), in_time);
    ASSERT_EQ(hal_replay_period.input_count, 1);
    EXPECT_EQ(hal_replay_period.inputs[0], in_time ? 1 : 0);
    hal_replay_start(REPLAY_OFF, nullptr);
  }
}

TEST_F(Pwm, interrupts_are_off_from_the_look_at_the_counter_to_the_last_write) {
  const hal_pwm_frame_t frame = frame_of_distinct_values();
  bus.ier = 0x0001;
  ASSERT_TRUE(hal_pwm_write(&frame, 9000));
  ASSERT_GE(bus.steps.size(), 2u);
  EXPECT_EQ(bus.steps.front().op, Op::kWriteIer);
  EXPECT_EQ(bus.steps.front().value, 0u);
  EXPECT_EQ(bus.steps.back().op, Op::kWriteIer);
  EXPECT_EQ(bus.steps.back().value, 0x0001u) << "what was enabled before";
  bus.words[EPWM_BASE(1) + EPWM_TBCTR] = 9001;
  EXPECT_FALSE(hal_pwm_write(&frame, 9000));
  EXPECT_EQ(bus.ier, 0x0001u) << "also when late";
}

TEST_F(Pwm, frame_is_written_within_the_published_time) {
  const hal_pwm_frame_t frame = frame_of_distinct_values();
  const std::uint64_t before = bus.cycles;
  ASSERT_TRUE(hal_pwm_write(&frame, 9000));
  // The accesses alone, at the fake's two cycles each; the chip's instructions in between need the rest.
  EXPECT_LE(bus.cycles - before, HAL_PWM_WRITE_TICKS / 2);
}

TEST_F(Pwm, gates_switch_on_and_off) {
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  EXPECT_TRUE(hal_pwm_gates_on());
  EXPECT_FALSE(hal_pwm_is_tripped());
  hal_pwm_gates_off();
  EXPECT_TRUE(hal_pwm_is_tripped());
  EXPECT_FALSE(hal_pwm_was_tripped_by_pin()) << "the software did it";
}

TEST_F(Pwm, gates_stay_off_while_the_over_current_input_is_low) {
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  bus.words[REG_GPADAT] = static_cast<std::uint16_t>(~kOverCurrentPin);
  bus.forget_steps();
  EXPECT_FALSE(hal_pwm_gates_on());
  EXPECT_EQ(bus.count_writes(), 0u) << "clearing the latch, even for a moment, would switch devices on";
  EXPECT_TRUE(hal_pwm_is_tripped());
}

// Over-current that comes just then, or a flag that does not clear.
TEST_F(Pwm, gates_that_do_not_come_on_are_told) {
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  for (unsigned leg = 1; leg <= 3; ++leg) {
    bus.between = [&] { bus.words[EPWM_BASE(leg) + EPWM_TZFLG] = EPWM_TZFLG_OST_MASK; };
    EXPECT_FALSE(hal_pwm_gates_on()) << "leg " << leg;
    bus.between = nullptr;
    EXPECT_TRUE(hal_pwm_gates_on());
  }
}

TEST_F(Pwm, every_leg_is_let_go_and_held_and_no_window) {
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  bus.forget_steps();
  ASSERT_TRUE(hal_pwm_gates_on());
  for (unsigned module = 1; module <= 6; ++module) {
    const std::size_t clear = bus.first_write(EPWM_BASE(module) + EPWM_TZCLR);
    EXPECT_EQ(clear != FakeBus::npos, module <= 4) << "the legs and the witness";
    if (clear != FakeBus::npos) {
      EXPECT_EQ(bus.steps.at(clear).value, EPWM_TZCLR_OST_MASK);
    }
  }
  expect_before(bus.first_write(EPWM_BASE(4) + EPWM_TZCLR), bus.first_write(EPWM_BASE(1) + EPWM_TZCLR),
                "the witness first: a trip in between is not lost");
  bus.forget_steps();
  hal_pwm_gates_off();
  EXPECT_EQ(bus.count_writes(), 3u);
  for (unsigned leg = 1; leg <= 3; ++leg) {
    EXPECT_EQ(bus.steps.at(bus.first_write(EPWM_BASE(leg) + EPWM_TZFRC)).value, EPWM_TZFRC_OST_MASK);
  }
}

TEST_F(Pwm, one_tripped_leg_is_enough) {
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  for (unsigned leg = 1; leg <= 3; ++leg) {
    ASSERT_TRUE(hal_pwm_gates_on());
    bus.words[EPWM_BASE(leg) + EPWM_TZFLG] = EPWM_TZFLG_OST_MASK;
    EXPECT_TRUE(hal_pwm_is_tripped()) << "leg " << leg;
  }
}

TEST_F(Pwm, trip_by_pin_is_told_from_trip_by_software) {
  ASSERT_TRUE(hal_pwm_init(kDeadBand));
  hal_safety_init();
  ASSERT_TRUE(hal_pwm_gates_on());
  // What TZ1 does on the chip: it trips every module that has selected it.
  for (unsigned module = 1; module <= 6; ++module) {
    if ((epwm(module, EPWM_TZSEL) & EPWM_TZSEL_OSHT1_MASK) != 0) {
      bus.words[EPWM_BASE(module) + EPWM_TZFLG] = EPWM_TZFLG_OST_MASK;
    }
  }
  EXPECT_TRUE(hal_pwm_is_tripped());
  EXPECT_TRUE(hal_pwm_was_tripped_by_pin());
  hal_pwm_gates_off();
  EXPECT_TRUE(hal_pwm_was_tripped_by_pin()) << "switching off in answer to a trip does not hide its cause";
  ASSERT_TRUE(hal_pwm_gates_on());
  EXPECT_FALSE(hal_pwm_was_tripped_by_pin());
}

}  // namespace stillspin::test
