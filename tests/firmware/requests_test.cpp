// What machines ask over the link, and what they are told.

#include "tests/firmware/requests.hpp"

#include <cstring>
#include <set>

extern "C" {
#include "estimators/wiring.h"
#include "firmware/base/crc.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/commissioning/phases.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/dictionary/version.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/states.h"
#include "firmware/scope/scope.h"
#include "firmware/start/step.h"
#include "firmware/text/catalogue.h"
#include "hal/hal_board.h"
#include "hal/hal_flash.h"
#include "hal/hal_image.h"
}

namespace {

#define FAULT(number, name, words, remedy) +1
constexpr int kFaults = 0
#include "firmware/dictionary/all_faults.h"
    ;
#undef FAULT

using namespace stillspin;
using namespace stillspin::test;

TEST_F(Requests, Identity) {
  const Answer a = ask(REQUEST_IDENTITY);
  ASSERT_TRUE(a.came());
  EXPECT_EQ(a.status(), OK);
  EXPECT_EQ(a.number(0, 2), LINK_PROTOCOL);
  EXPECT_EQ(a.number(2, 2), parameter_count());
  EXPECT_EQ(a.number(4, 2), signal_count());
  EXPECT_EQ(a.number(6, 2), kFaults);
  const std::string names = std::string(FIRMWARE_NAME) + '\0' + BOARD_NAME + '\0';
  EXPECT_EQ(a.text(12), names + std::string(6, '\0') + edition_name) << "no image: the commit is not known";
  EXPECT_EQ(std::string(FIRMWARE_VERSION), STILLSPIN_VERSION) << "of CMakeLists.txt";
}

TEST_F(Requests, IdentityNamesTheCommitOfTheImage) {
  board.flash[HAL_FLASH_IMAGE_IDENTITY] = HAL_IMAGE_MARK;
  board.flash[HAL_FLASH_IMAGE_IDENTITY + HAL_IMAGE_REVISION] = 0x4321;
  board.flash[HAL_FLASH_IMAGE_IDENTITY + HAL_IMAGE_REVISION + 1] = 0x8765;
  board.flash[HAL_FLASH_IMAGE_IDENTITY + HAL_IMAGE_CHANGED] = 1;
  const Answer a = ask(REQUEST_IDENTITY);
  ASSERT_EQ(a.status(), OK);
  const std::size_t behind = a.body() - 6 - std::string(edition_name).size();
  EXPECT_EQ(a.number(behind, 4), 0x87654321u);
  EXPECT_EQ(a.number(behind + 4, 2), 1u);
}

// A host keeps the tables by this number: it must be that of the tables as they are told.
TEST_F(Requests, TheTablesSumIsThatOfWhatIsTold) {
  std::uint32_t crc = CRC32_BEGIN;
  const auto add = [&](const Answer& a) {
    if (a.status() == EDITION) return;
    for (std::size_t k = 3; k < a.octets.size(); ++k) crc = crc32_add(crc, a.octets[k]);
  };
  for (std::uint16_t k = 0; k < parameter_count(); ++k) add(ask(REQUEST_PARAMETER_INFO, little(k, 2)));
  for (std::uint16_t k = 0; k < signal_count(); ++k) add(ask(REQUEST_SIGNAL_INFO, little(k, 2)));
  for (std::uint16_t kind = 0; kind < CATALOGUES; ++kind) {
    for (std::uint16_t code = 0;; ++code) {
      const Answer a = ask(REQUEST_WORDS, {kind, code});
      if (a.status() == RANGE) break;
      add(a);
    }
  }
  EXPECT_EQ(ask(REQUEST_IDENTITY).number(8, 4), crc32_end(crc));
}

TEST_F(Requests, IdentityIsBusyUntilTheSumIsThere) {
  requests_reset();
  std::uint16_t answer[RECORD_MAX];
  const std::uint16_t request[] = {REQUEST_IDENTITY, 7};
  ASSERT_EQ(request_answer(COMM_WATCHDOG_BUS, request, 2, answer), 3);
  EXPECT_EQ(answer[2], BUSY);
}

TEST_F(Requests, EveryParameterTellsAllOfItself) {
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    const parameter_info_t& p = *parameter_info(k);
    const Answer a = ask(REQUEST_PARAMETER_INFO, little(k, 2));
    ASSERT_EQ(a.status(), OK);
    EXPECT_EQ(a.number(0, 2), p.id);
    EXPECT_EQ(a.number(2, 1), p.q);
    EXPECT_EQ(a.number(3, 1), p.decimals);
    EXPECT_EQ(a.number(4, 1), static_cast<unsigned>(p.access));
    EXPECT_EQ(static_cast<std::int32_t>(a.number(6, 4)), parameter_minimum(&p));
    EXPECT_EQ(static_cast<std::int32_t>(a.number(10, 4)), parameter_maximum(&p));
    EXPECT_EQ(static_cast<std::int32_t>(a.number(14, 4)), parameter_initial(&p));
    const std::string words = bench::text_of(parameter_name(&p)) + '\0' + bench::text_of(parameter_unit(&p)) + '\0' +
                              bench::text_of(parameter_meaning(&p));
    EXPECT_EQ(a.text(18), words) << "whole: nothing is cut off";
  }
  EXPECT_EQ(ask(REQUEST_PARAMETER_INFO, little(parameter_count(), 2)).status(), RANGE);
  const Answer s = ask(REQUEST_SIGNAL_INFO, little(3, 2));
  EXPECT_EQ(s.number(0, 1), 32u | 0x40u) << "and of the rotor";
  EXPECT_EQ(s.text(1).substr(0, 11), std::string("angle\0turn\0", 11));
}

TEST_F(Requests, ReadGetAndSet) {
  std::set<std::uint32_t> ids;
  for (std::uint16_t at = 0; at < parameter_count(); at = static_cast<std::uint16_t>(at + 32)) {
    const Answer a = ask(REQUEST_PARAMETER_READ, little(at, 2) + little(32, 1));
    ASSERT_EQ(a.status(), OK);
    for (std::size_t k = 0; k < a.body(); k += 6) {
      ids.insert(a.number(k, 2));
      EXPECT_EQ(static_cast<std::int32_t>(a.number(k + 2, 4)),
                parameter_get(static_cast<std::uint16_t>(a.number(k, 2))));
    }
  }
  EXPECT_EQ(ids.size(), parameter_count());
  EXPECT_EQ(ask(REQUEST_PARAMETER_READ, little(0, 2) + little(33, 1)).status(), RANGE);
  EXPECT_EQ(set(86, 500 * 256).number(0, 4), 500u * 256u);
  EXPECT_EQ(ask(REQUEST_PARAMETER_GET, little(86, 2)).number(0, 4), 500u * 256u);
  EXPECT_TRUE(inside::reload_requested());
  EXPECT_EQ(ask(REQUEST_PARAMETER_GET, little(19, 2)).status(), UNKNOWN);
  EXPECT_EQ(set(19, 0).status(), UNKNOWN);
}

TEST_F(Requests, ARefusalSaysWhy) {
  const Answer range = set(9, 70000 * 256);
  EXPECT_EQ(range.status(), RANGE);
  EXPECT_EQ(range.text(), "speed_limit = 70000.0 is outside of 10 .. 20000 rpm: nothing changed");
  EXPECT_EQ(parameter_get(9), 3300 * 256);
  inside::be_in(DRIVE_RUN);
  const Answer running = set(9, 1000 * 256);
  EXPECT_EQ(running.status(), RUNNING);
  EXPECT_EQ(running.text(), "speed_limit may not change while the power stage is on: stop the drive first");
  EXPECT_EQ(parameter_get(9), 3300 * 256);
}

// Two parameters that must fit can only be changed one after the other.
TEST_F(Requests, AConflictIsTakenAtRestAndRefusedInRun) {
  const Answer rest = set(42, 40 * 65536 / 10 * 10 / 16);  // window_minimum 2.5 us: below settle_time + 4.5 us
  EXPECT_EQ(rest.status(), RANGE) << "a range comes first";
  const std::int32_t long_window = 30 * 65536;
  const Answer taken = set(43, 10 * 65536);  // window_maximum below window_minimum
  EXPECT_EQ(taken.status(), CONFLICT);
  EXPECT_EQ(taken.text(),
            "set, but the drive does not start with it: window_maximum must be at least window_minimum "
            "(window_maximum = 10.00 us, window_minimum = 18.00 us)");
  EXPECT_EQ(parameter_get(43), 10 * 65536);
  inside::be_in(DRIVE_READY);
  EXPECT_EQ(give(COMMAND_START).status(), CONFLICT);
  EXPECT_FALSE(inside::start_requested());
  EXPECT_EQ(set(43, long_window).status(), OK);
  inside::be_in(DRIVE_RUN);
  const Answer refused = set(43, 10 * 65536);
  EXPECT_EQ(refused.status(), CONFLICT);
  EXPECT_EQ(refused.text().substr(0, 30), "not taken while the drive runs");
  EXPECT_EQ(parameter_get(43), long_window);
}

TEST_F(Requests, Commands) {
  NEEDS("commissioning");
  EXPECT_EQ(give(COMMAND_START).status(), STATE) << "not calibrated yet";
  inside::be_in(DRIVE_READY);
  EXPECT_EQ(give(COMMAND_SPEED, 600 * 65536).status(), OK);
  EXPECT_EQ(drive_commanded_speed(), 600 * 65536);
  const Answer fast = give(COMMAND_SPEED, 4000 * 65536);
  EXPECT_EQ(fast.status(), RANGE);
  EXPECT_EQ(fast.text(), "4000.0 rpm is beyond speed_limit, 3300 rpm: nothing changed");
  EXPECT_EQ(drive_commanded_speed(), 600 * 65536);
  EXPECT_EQ(give(COMMAND_START).status(), OK);
  EXPECT_TRUE(inside::start_requested());
  EXPECT_EQ(give(COMMAND_STOP).status(), OK);
  EXPECT_TRUE(inside::stop_requested());
  EXPECT_FALSE(inside::start_requested()) << "a start that was not carried out yet must not outlive the stop";
  EXPECT_EQ(give(COMMAND_COMMISSION).status(), OK);
  EXPECT_EQ(give(COMMAND_COAST).status(), OK);
  EXPECT_EQ(inside::state_requested(), nullptr);
  EXPECT_EQ(give(COMMAND_RESET).status(), STATE);
  inside::be_in(DRIVE_FAULT);
  inside::fault() = FAULT_STOP;
  EXPECT_EQ(give(COMMAND_START).text(), "a fault is latched, reset it first: standstill not reached within stop_time");
  EXPECT_EQ(give(COMMAND_RESET).status(), OK);
  EXPECT_TRUE(inside::reset_requested());
  EXPECT_EQ(give(77).status(), UNKNOWN);
}

TEST_F(Requests, TheStore) {
  NEEDS("store");
  EXPECT_EQ(set(86, 500 * 256).status(), OK);
  EXPECT_EQ(give(COMMAND_SAVE).status(), OK);
  run(20000);
  EXPECT_EQ(ask(REQUEST_STATUS).number(16, 1), static_cast<unsigned>(STORE_SAVED));
  EXPECT_EQ(give(COMMAND_DEFAULTS).status(), OK);
  EXPECT_EQ(parameter_get(86), 3000 * 256);
  EXPECT_EQ(give(COMMAND_LOAD).status(), OK);
  run(20000);
  EXPECT_EQ(parameter_get(86), 500 * 256);
  ASSERT_TRUE(store_save());
  std::uint16_t answer[RECORD_MAX];
  const std::uint16_t save[] = {REQUEST_COMMAND, 1, COMMAND_SAVE, 0, 0, 0, 0};
  (void)request_answer(COMM_WATCHDOG_SERIAL, save, 7, answer);
  EXPECT_EQ(answer[2], BUSY);
  const std::uint16_t load[] = {REQUEST_COMMAND, 2, COMMAND_LOAD, 0, 0, 0, 0};
  (void)request_answer(COMM_WATCHDOG_SERIAL, load, 7, answer);
  EXPECT_EQ(answer[2], BUSY) << "at rest as well";
  run(20000);
  inside::be_in(DRIVE_RUN);
  EXPECT_EQ(give(COMMAND_LOAD).status(), RUNNING);
  EXPECT_EQ(give(COMMAND_DEFAULTS).status(), RUNNING);
}

TEST_F(Requests, StatusAndSignals) {
  inside::be_in(DRIVE_RUN);
  inside::selected().speed_bpp = bpp_of(-123);
  inside::ramped_bpp() = bpp_of(600);
  inside::limits() = LIMIT_VOLTAGE | LIMIT_BRAKING;
  const Answer a = ask(REQUEST_STATUS);
  ASSERT_EQ(a.body(), 25u);
  EXPECT_NEAR(a.number(0, 4), inside::time_ms(), 45);
  EXPECT_EQ(a.number(4, 1), static_cast<unsigned>(DRIVE_RUN));
  EXPECT_EQ(a.number(6, 2), static_cast<unsigned>(LIMIT_VOLTAGE | LIMIT_BRAKING));
  EXPECT_NEAR(static_cast<std::int32_t>(a.number(8, 4)), -123 * 65536, 3);
  EXPECT_NEAR(a.number(12, 4), 600 * 65536, 3);
  const Answer s = ask(REQUEST_SIGNALS, little(4, 2) + little(2, 2));
  ASSERT_EQ(s.body(), 9u);
  EXPECT_EQ(s.number(8, 1), 3u);
  EXPECT_NEAR(static_cast<std::int32_t>(s.number(0, 4)), -123 * 65536, 3);
  EXPECT_EQ(s.number(4, 4), static_cast<unsigned>(LIMIT_VOLTAGE | LIMIT_BRAKING));
  EXPECT_EQ(ask(REQUEST_SIGNALS, little(signal_count(), 2)).status(), RANGE);
  EXPECT_EQ(ask(REQUEST_SIGNALS, Octets(34, 0)).status(), LENGTH);
  EXPECT_EQ(ask(REQUEST_SIGNALS, Octets(3, 0)).status(), LENGTH);
}

TEST_F(Requests, FaultsWithTheirCircumstances) {
  EXPECT_EQ(ask(REQUEST_FAULT, {0}).status(), RANGE);
  make_run();
  board.tripped_by_pin = true;
  inside::selected().speed_bpp = q_mul(inside::config().bpp_per_rpm_q8, 600 * 256, 16);
  inside::current_dq_q20().q = 3 << 20;
  const std::uint32_t then = inside::time_ms();
  drive_trip(&drive, FAULT_OVER_CURRENT);
  drive_trip(&drive, FAULT_STOP);  // one that comes on top is none of its own
  const Answer a = ask(REQUEST_FAULT, {0});
  EXPECT_EQ(a.number(0, 2), 1u);
  EXPECT_EQ(a.number(2, 4), then);
  EXPECT_EQ(a.number(6, 1), static_cast<unsigned>(FAULT_OVER_CURRENT));
  EXPECT_EQ(a.number(7, 1), static_cast<unsigned>(DRIVE_RUN));
  EXPECT_NEAR(real(static_cast<std::int32_t>(a.number(8, 4)), 16), 600.0, 0.01);
  EXPECT_NEAR(real(static_cast<std::int32_t>(a.number(12, 4)), 16), 300.0, 1.0);
  EXPECT_EQ(static_cast<std::int32_t>(a.number(20, 4)), 3 << 20);
}

TEST_F(Requests, TheHistoryKeepsTheLastSixteen) {
  for (int k = 0; k < 20; ++k) {
    inside::be_in(DRIVE_READY);
    inside::time_ms() = static_cast<std::uint32_t>(100 + k);
    drive_trip(&drive, FAULT_OFFSET);
  }
  EXPECT_EQ(fault_history_total(), 20);
  fault_record_t r;
  ASSERT_TRUE(fault_history_read(0, &r));
  EXPECT_EQ(r.time_ms, 119u);
  ASSERT_TRUE(fault_history_read(15, &r));
  EXPECT_EQ(r.time_ms, 104u);
  EXPECT_FALSE(fault_history_read(16, &r));
}

TEST_F(Requests, WordsForEverything) {
  const auto last = [&](std::uint16_t kind) {
    std::uint16_t code = 0;
    while (message_is_known(kind, code)) code++;
    return code - 1;
  };
  EXPECT_EQ(last(CATALOGUE_STATE), DRIVE_COMMISSION);
  EXPECT_EQ(last(CATALOGUE_FAULT), kFaults - 1);
  EXPECT_EQ(last(CATALOGUE_REMEDY), kFaults - 1);
  EXPECT_EQ(1 << last(CATALOGUE_LIMIT), LIMIT_BRAKING);
  EXPECT_EQ(last(CATALOGUE_VERDICT), VERDICT_DEPENDS);
  EXPECT_EQ(last(CATALOGUE_PHASE), COMMISSIONING_COOLING);
  EXPECT_EQ(last(CATALOGUE_STATUS), EDITION);
  EXPECT_EQ(last(CATALOGUE_START), START_CHARGE);
  EXPECT_EQ(last(CATALOGUE_BOARD), 13);    // board_words_t
  EXPECT_EQ(last(CATALOGUE_SELFTEST), 9);  // board/selftest.c
  EXPECT_EQ(last(CATALOGUE_WIRING), WIRING_OTHER_PHASES);
  EXPECT_EQ(last(CATALOGUE_COMMISSIONING), COMMISSIONING_FAILED);
  EXPECT_EQ(last(CATALOGUE_SCOPE), SCOPE_DONE);
  EXPECT_EQ(last(CATALOGUE_STORE), STORE_OLDER);
  EXPECT_EQ(last(CATALOGUE_CAN), HAL_CAN_BUS_OFF);
  EXPECT_EQ(ask(REQUEST_WORDS, {CATALOGUE_FAULT, 12}).text(), "loss of synchronism");
  EXPECT_EQ(ask(REQUEST_WORDS, {CATALOGUE_FAULT, 99}).status(), RANGE);
  EXPECT_EQ(ask(REQUEST_WORDS, {CATALOGUES, 0}).status(), UNKNOWN);
}

TEST_F(Requests, ResultsOfACommissioning) {
  NEEDS("commissioning");
  EXPECT_EQ(ask(REQUEST_COMMISSION_RESULT, little(0, 2)).octets.size(), 3u + 2u) << "there are none: the number alone";
  commissioning.evaluate = true;  // and nothing was measured
  commissioning_service(&drive);
  const std::uint16_t count = drive_commissioning_count();
  const Answer last = ask(REQUEST_COMMISSION_RESULT, little(count - 1u, 2));
  EXPECT_EQ(last.number(0, 2), count);
  EXPECT_EQ(last.number(2, 2), drive_commissioning_result(count - 1u)->id);
  EXPECT_EQ(last.number(12, 1), static_cast<unsigned>(VERDICT_NOT_MEASURED));
  EXPECT_EQ(ask(REQUEST_COMMISSION_RESULT, little(count, 2)).body(), 2u);
}

TEST_F(Requests, WrongLengthsAndTypes) {
  EXPECT_EQ(ask(REQUEST_STATUS, {1}).status(), LENGTH);
  EXPECT_EQ(ask(REQUEST_PARAMETER_SET, little(9, 2)).status(), LENGTH);
  EXPECT_EQ(ask(0x3F).status(), UNKNOWN);
  EXPECT_EQ(ask(0x00).status(), UNKNOWN);
  EXPECT_FALSE(ask(0x88).came()) << "an answer that comes back must not be answered";
  const std::uint16_t type = REQUEST_STATUS;
  std::uint16_t answer[RECORD_MAX];
  EXPECT_EQ(request_answer(COMM_WATCHDOG_BUS, &type, 1, answer), 0) << "without a tag there is nothing to answer to";
}

TEST_F(Requests, LinkErrorsAreCounted) {
  send(Octets{0, 9, 9, 9, 0});
  board.serial_errors.framing = 3;
  const Answer a = ask(REQUEST_LINK);
  EXPECT_EQ(a.number(0, 2), 1u);
  EXPECT_EQ(a.number(6, 2), 3u);
}

Octets scope_setup_body(std::uint16_t edge, Octets channels) {
  return little(2, 2) + little(4, 2) + little(0, 1) + little(edge, 1) + little(4, 2) + little(100u << 16, 4) +
         little(static_cast<std::uint32_t>(channels.size() / 3), 1) + channels;
}

TEST_F(Requests, TheScopeTakesAsManyChannelsAsItHas) {
  NEEDS("scope");
  Octets channels;
  for (std::uint16_t k = 0; k < SCOPE_CHANNELS; ++k)
    channels = channels + Octets{static_cast<std::uint16_t>(k + 3), 0, k};
  EXPECT_EQ(ask(REQUEST_SCOPE_SETUP, scope_setup_body(SCOPE_RISING, channels)).status(), OK);
  for (std::uint16_t k = 0; k < SCOPE_CHANNELS; ++k) {
    EXPECT_EQ(scope_setup_in_force()->channel[k].signal, k + 3);
    EXPECT_EQ(scope_setup_in_force()->channel[k].shift, k);
  }
  EXPECT_EQ(ask(REQUEST_SCOPE_SETUP, scope_setup_body(SCOPE_RISING, channels + Octets{3, 0, 0})).status(), RANGE);
}

TEST_F(Requests, TheScopeFromSetUpToTheLastWord) {
  NEEDS("scope");
  EXPECT_EQ(ask(REQUEST_SCOPE_ARM).status(), STATE);
  EXPECT_EQ(ask(REQUEST_SCOPE_SETUP, scope_setup_body(SCOPE_RISING, {4, 0, 16, 0, 0, 0})).status(), OK);
  EXPECT_EQ(ask(REQUEST_SCOPE_SETUP, scope_setup_body(9, {4, 0, 16})).status(), RANGE);
  EXPECT_EQ(ask(REQUEST_SCOPE_SETUP, scope_setup_body(SCOPE_RISING, {200, 0, 16})).status(), RANGE);
  Octets wrong = scope_setup_body(SCOPE_RISING, {4, 0, 16});
  wrong[12] = 2;
  EXPECT_EQ(ask(REQUEST_SCOPE_SETUP, wrong).status(), LENGTH);
  EXPECT_EQ(ask(REQUEST_SCOPE_ARM).status(), OK);
  inside::be_in(DRIVE_RUN);
  for (int k = 0; k < 3000; ++k) {
    inside::selected().speed_bpp = bpp_of(k);
    inside::time_ms() = static_cast<std::uint32_t>(k);
    if (drive_onlooker != nullptr) drive_onlooker();
  }
  const Answer state = ask(REQUEST_SCOPE_STATE);
  EXPECT_EQ(state.number(0, 1), static_cast<unsigned>(SCOPE_DONE));
  EXPECT_EQ(state.number(1, 2), SCOPE_DEPTH);
  EXPECT_EQ(state.number(3, 2), 4u);
  const Answer data = ask(REQUEST_SCOPE_READ, {0, 4, 0, 100});
  ASSERT_EQ(data.body(), 200u);
  EXPECT_NEAR(data.number(0, 2), 100, 1);
  EXPECT_EQ(data.number(2, 2), data.number(0, 2) + 2);
  EXPECT_EQ(ask(REQUEST_SCOPE_READ, {0, 4, 0, 101}).status(), RANGE);
  EXPECT_EQ(ask(REQUEST_SCOPE_READ, {3, 4, 0, 1}).body(), 0u) << "a channel that is not set up";
  EXPECT_EQ(ask(REQUEST_SCOPE_STOP).status(), OK);
}

TEST(Signals, ACopyIsOfOneInterruptAndHasItsTime) {
  drive_reset();
  inside::time_ms() = 5;
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20().d = 6;
  const std::uint16_t places[] = {9, 60000};
  std::int32_t values[2] = {-1, -1};
  EXPECT_EQ(drive_signals_copy(places, 2, values).time_ms, 5u);
  EXPECT_EQ(values[0], 6);
  EXPECT_EQ(values[1], 0);
  EXPECT_EQ(drive_signals_copy(places, 1, values).known, KNOWN_ROTOR | KNOWN_FRAME);
  inside::be_in(DRIVE_READY);
  EXPECT_EQ(drive_signals_copy(places, 1, values).known, 0);
  EXPECT_EQ(values[0], 0);
}

}  // namespace
