// Safety lines, encoder, cycle counter, watchdog: the small drivers.

#include "hal/f2808/registers.h"
#include "hal/hal_encoder.h"
#include "hal/hal_profile.h"
#include "hal/hal_safety.h"
#include "hal/hal_time.h"
#include "tests/hal/bus.hpp"

namespace stillspin::test {

namespace {
constexpr std::uint32_t kLamp = 1u << 27;
constexpr std::uint32_t kEnable = 1u << 2;  // GPIO34 in port B
constexpr std::uint32_t kTrip = 1u << 12;
}  // namespace

class Board : public BusTest {
 protected:
  void SetUp() override { bus.power_all(); }
};

TEST_F(Board, over_current_input_is_asynchronous_with_pull_up) {
  bus.words[REG_GPAPUD] = 0xFFFF;
  hal_safety_init();
  EXPECT_EQ(bus.word32(REG_GPAPUD) & kTrip, 0u) << "a broken wire must not float";
  EXPECT_EQ(pair_of(bus.word32(REG_GPAQSEL1), 12), 3u) << "works without a clock";
  EXPECT_EQ(pair_of(bus.word32(REG_GPAMUX1), 12), 1u) << "TZ1";
  expect_before(bus.first_write(REG_GPAQSEL1), bus.first_write(REG_GPAMUX1), "settings before the multiplexer");
  EXPECT_EQ(bus.words[REG_GPAPUD], 0xFFFF & ~kTrip) << "other pins are kept";
}

TEST_F(Board, over_current_trips_the_legs_and_the_witness) {
  hal_safety_init();
  for (unsigned module = 1; module <= 6; ++module) {
    EXPECT_EQ(bus.words[EPWM_BASE(module) + EPWM_TZSEL], module <= 4 ? EPWM_TZSEL_OSHT1_MASK : 0u)
        << "ePWM" << module << ": one-shot for 1..3 and for 4, whose flag tells a trip by pin from one by software";
  }
  expect_before(bus.first_write(REG_GPAMUX1), bus.first_write(EPWM_BASE(1) + EPWM_TZSEL),
                "the pin before it is selected, or its level before connection would trip");
}

TEST_F(Board, safety_outputs_start_low) {
  hal_safety_init();
  expect_before(bus.first_write(REG_GPBCLEAR, kEnable), bus.first_write(REG_GPBDIR, kEnable), "level before direction");
  expect_before(bus.first_write(REG_GPACLEAR, kLamp), bus.first_write(REG_GPADIR, kLamp), "level before direction");
  EXPECT_EQ(bus.word32(REG_GPBDIR), kEnable);
  EXPECT_EQ(bus.word32(REG_GPADIR), kLamp);
}

TEST_F(Board, enable_toggles_and_lamp_switches) {
  hal_safety_toggle_enable();
  ASSERT_EQ(bus.steps.size(), 1u);
  EXPECT_EQ(bus.steps.at(0).address, REG_GPBTOGGLE);
  EXPECT_EQ(bus.steps.at(0).value, kEnable);
  hal_safety_fault_lamp(true);
  EXPECT_EQ(bus.steps.back().address, REG_GPASET);
  EXPECT_EQ(bus.steps.back().value, kLamp);
  hal_safety_fault_lamp(false);
  EXPECT_EQ(bus.steps.back().address, REG_GPACLEAR);
  EXPECT_EQ(bus.steps.back().value, kLamp);
}

TEST_F(Board, encoder_counts_one_turn_and_wraps_there) {
  const std::uint32_t eqep = EQEP_BASE(1);
  for (std::uint32_t n = 0; n < EQEP_QPOSCNT + 0x20; ++n) bus.words[eqep + n] = 0xFFFF;  // an earlier user's
  hal_encoder_init(4096);
  EXPECT_EQ(bus.word32(eqep + EQEP_QPOSMAX), 4095u);
  EXPECT_EQ(bus.words[eqep + EQEP_QDECCTL], 0u) << "quadrature, nothing inverted or swapped";
  EXPECT_EQ(bus.words[eqep + EQEP_QEPCTL], 0x9008u) << "free run, reset at maximum, counter on";
  expect_before(bus.last_write(eqep + EQEP_QPOSCNT), bus.last_write(eqep + EQEP_QEPCTL), "counter set, then on");
  for (unsigned pin : {20u, 21u, 23u}) {
    EXPECT_EQ(pair_of(bus.word32(REG_GPAMUX2), pin), 1u) << "GPIO" << pin;
  }
  EXPECT_EQ(pair_of(bus.word32(REG_GPAMUX2), 22), 0u);
  EXPECT_EQ(bus.word32(eqep + EQEP_QPOSINIT), 0u);
  EXPECT_EQ(bus.word32(eqep + EQEP_QPOSCNT), 0u);
  EXPECT_EQ(bus.steps.at(bus.first_write(eqep + EQEP_QEPCTL)).value, 0u);
  expect_before(bus.first_write(eqep + EQEP_QEPCTL), bus.first_write(eqep + EQEP_QDECCTL), "off while it changes");
  expect_before(bus.last_write(REG_GPAMUX2), bus.last_write(eqep + EQEP_QPOSCNT),
                "the pins first: their connection may look like an edge");
  bus.words[eqep + EQEP_QPOSCNT] = 0x0ABC;
  EXPECT_EQ(hal_encoder_count(), 0x0ABCu);
  bus.words[eqep + EQEP_QPOSCNT + 1] = 0x0012;
  EXPECT_EQ(hal_encoder_count(), 0x120ABCu) << "more than a word";
}

// Noise shorter than half a microsecond is no edge; at 6000 rpm 1024 lines give one every 2.4 us.
TEST_F(Board, encoder_filters_its_pins_for_half_a_microsecond) {
  bus.words[REG_GPACTRL] = 0x1234;
  bus.words[REG_GPACTRL + 1] = 0x5600;
  bus.words[REG_GPAPUD + 1] = 0xFFFF;
  hal_encoder_init(4096);
  const std::uint32_t control = bus.word32(REG_GPACTRL);
  const unsigned sampling = 2 * (control >> 16 & 0xFFu);  // cycles of 10 ns between two samples
  EXPECT_EQ((6 - 1) * sampling * 10, 500u) << "ns";
  EXPECT_EQ(control & 0xFF00FFFFu, 0x56001234u) << "other pins have their own";
  for (unsigned pin : {20u, 21u, 23u}) {
    EXPECT_EQ(pair_of(bus.word32(REG_GPAQSEL2), pin), 2u) << "six samples, GPIO" << pin;
    EXPECT_EQ(bus.word32(REG_GPAPUD) >> pin & 1u, 0u) << "an open collector needs it, GPIO" << pin;
  }
}

TEST_F(Board, cycle_counter_counts_up_freely) {
  const std::uint32_t timer = CPUTIMER_BASE(2);
  for (std::uint32_t n = 0; n <= CPUTIMER_TPRH; ++n) bus.words[timer + n] = 0x0FFF;  // an earlier user's
  hal_time_init();
  EXPECT_EQ(bus.word32(timer + CPUTIMER_PRD), 0xFFFFFFFFu);
  EXPECT_EQ(bus.words[timer + CPUTIMER_TPR], 0u) << "every SYSCLKOUT";
  EXPECT_EQ(bus.words[timer + CPUTIMER_TPRH], 0u);
  const std::size_t stop = bus.first_write(timer + CPUTIMER_TCR, CPUTIMER_TCR_TSS_MASK);
  EXPECT_EQ(bus.steps.at(stop).value, CPUTIMER_TCR_TSS_MASK);
  expect_before(stop, bus.first_write(timer + CPUTIMER_PRD), "stopped while it changes");
  const std::size_t reload = bus.first_write(timer + CPUTIMER_TCR, CPUTIMER_TCR_TRB_MASK);
  EXPECT_EQ(bus.steps.at(reload).value, CPUTIMER_TCR_TSS_MASK | CPUTIMER_TCR_TRB_MASK) << "stopped while it reloads";
  expect_before(bus.first_write(timer + CPUTIMER_TCR, CPUTIMER_TCR_TRB_MASK), bus.last_write(timer + CPUTIMER_TCR),
                "reload before the start");
  EXPECT_EQ(bus.words[timer + CPUTIMER_TCR], CPUTIMER_TCR_FREE_MASK) << "no interrupt, and a debugger does not stop it";
  const std::uint32_t before = hal_time_cycles();
  hal_profile_step(1000);
  const std::uint32_t passed = hal_time_cycles() - before;
  EXPECT_GE(passed, 1000u);
  EXPECT_LE(passed, 1010u) << "the read itself takes a few cycles";
}

TEST_F(Board, watchdog_starts_fresh_and_resets_the_chip) {
  bus.words[REG_SCSR] = SCSR_WDENINT_MASK;
  hal_watchdog_start();
  EXPECT_EQ(bus.words[REG_WDCR], 0x002Bu) << "on, check bits 101, /4: 26.2 ms";
  EXPECT_EQ(bus.words[REG_SCSR], 0u) << "resets instead of interrupting, and WDOVERRIDE is left alone";
  expect_before(bus.first_write(REG_WDKEY), bus.first_write(REG_WDCR), "counter cleared before it counts");
}

TEST_F(Board, watchdog_is_serviced_by_the_two_keys_in_order) {
  hal_watchdog_service();
  ASSERT_EQ(bus.count_writes(), 2u);
  const std::size_t first = bus.first_write(REG_WDKEY);
  EXPECT_EQ(bus.steps.at(first).value, 0x55u);
  EXPECT_EQ(bus.steps.at(bus.last_write(REG_WDKEY)).value, 0xAAu);
}

TEST_F(Board, cause_of_reset_is_readable) {
  EXPECT_FALSE(hal_watchdog_caused_reset());
  bus.words[REG_WDCR] = WDCR_WDFLAG_MASK;
  EXPECT_TRUE(hal_watchdog_caused_reset());
}

TEST_F(Board, idle_sleeps) {
  hal_idle();
  ASSERT_EQ(bus.steps.size(), 1u);
  EXPECT_EQ(bus.steps.at(0).op, Op::kIdle);
}

}  // namespace stillspin::test
