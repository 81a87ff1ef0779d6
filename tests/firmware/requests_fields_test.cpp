// Every field of requests and answers, and every length, as docs/protocol.md has them.

#include "tests/firmware/requests.hpp"

extern "C" {
#include "firmware/commissioning/outcome.h"
#include "firmware/commissioning/phases.h"
#include "firmware/console/output.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/hil/hil.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/states.h"
#include "firmware/scope/scope.h"
}

namespace {

using namespace stillspin;
using namespace stillspin::test;

class RequestFields : public Requests {
 protected:
  static Octets of(const Answer& a) { return Octets(a.octets.begin() + 3, a.octets.end()); }
  static Octets i32(std::int32_t value) { return little(static_cast<std::uint32_t>(value), 4); }
};

TEST_F(RequestFields, EachTypeHasItsLengths) {
  const struct {
    unsigned type;
    std::size_t shortest, longest;
  } types[] = {
      {REQUEST_IDENTITY, 0, 0},
      {REQUEST_PARAMETER_INFO, 2, 2},
      {REQUEST_SIGNAL_INFO, 2, 2},
      {REQUEST_PARAMETER_READ, 3, 3},
      {REQUEST_PARAMETER_GET, 2, 2},
      {REQUEST_PARAMETER_SET, 6, 6},
      {REQUEST_COMMAND, 5, 5},
      {REQUEST_STATUS, 0, 0},
      {REQUEST_SIGNALS, 2, 32},
      {REQUEST_FAULT, 1, 1},
      {REQUEST_WORDS, 2, 2},
      {REQUEST_LINK, 0, 0},
      {REQUEST_SCOPE_SETUP, 16, 29},
      {REQUEST_SCOPE_ARM, 0, 0},
      {REQUEST_SCOPE_STATE, 0, 0},
      {REQUEST_SCOPE_READ, 4, 4},
      {REQUEST_SCOPE_STOP, 0, 0},
      {REQUEST_STREAM, 2, 18},
      {REQUEST_HIL_ENTER, 0, 0},
      {REQUEST_HIL_LEAVE, 0, 0},
      {REQUEST_COMMISSION_RESULT, 2, 2},
      {REQUEST_HIL_STEP, 3, RECORD_BODY_MAX},
  };
  for (const auto& t : types) {
    Octets body(t.longest + 1, 0);
    if (ask(t.type, body).status() == EDITION) continue;  // of which tests/python has the list
    EXPECT_EQ(ask(t.type, body).status(), LENGTH) << t.type;
    for (const std::size_t length : {t.shortest, t.longest}) {
      body.assign(length, 0);
      if (t.type == REQUEST_SCOPE_SETUP) body[12] = length == t.longest ? 4 : 1;  // with a hysteresis
      EXPECT_NE(ask(t.type, body).status(), LENGTH) << t.type << ", " << length;
      hil_reset();
    }
    if (t.shortest == 0) continue;
    EXPECT_EQ(ask(t.type, Octets(t.shortest - 1, 0)).status(), LENGTH) << t.type;
  }
  EXPECT_EQ(ask(REQUEST_STREAM, Octets(3, 0)).status(), LENGTH) << "half a signal";
}

TEST_F(RequestFields, StatusTellsHowTheDriveIs) {
  NEEDS("store", "commissioning");
  nvm.latency = 20;  // so that it is under way behind the command, however little there is to save
  ASSERT_EQ(give(COMMAND_SAVE).status(), OK);
  for (int k = 0; k < 1000 && store_progress() < 20; ++k) run(1);
  nvm.latency = 1'000'000;
  run(100);
  ASSERT_GE(store_progress(), 20);
  ASSERT_LT(store_progress(), 100);
  inside::be_in(DRIVE_COMMISSION);
  inside::fault() = FAULT_STOP;
  commissioning.outcome = COMMISSIONING_RUNNING;
  commissioning.phase = COMMISSIONING_MAP;
  commissioning.map.level = 3;
  ASSERT_GT(drive_commissioning_progress(), 255) << "both octets of it";
  const Octets told = of(ask(REQUEST_STATUS));
  ASSERT_EQ(told.size(), 25u);
  EXPECT_EQ(Octets(told.begin() + 4, told.begin() + 6), Octets({DRIVE_COMMISSION, FAULT_STOP}));
  EXPECT_EQ(Octets(told.begin() + 16, told.end()),
            Octets({STORE_SAVING, store_progress(), COMMISSIONING_RUNNING, COMMISSIONING_MAP}) +
                little(static_cast<std::uint32_t>(drive_commissioning_progress()), 2) +
                Octets({0, 3, store_unsaved()}));
}

TEST_F(RequestFields, AFaultIsToldAsItWasRecorded) {
  const fault_record_t older = {0x12345678, FAULT_OVER_CURRENT, DRIVE_STOP, 3, -70000, 0x01020304, -5, 0x7F000001};
  fault_record_t newer = older;
  newer.time_ms++;
  fault_history_add(&older);
  fault_history_add(&newer);
  const Octets rest =
      Octets{FAULT_OVER_CURRENT, DRIVE_STOP} + i32(-70000) + i32(0x01020304) + i32(-5) + i32(0x7F000001) + Octets{3};
  EXPECT_EQ(of(ask(REQUEST_FAULT, {1})), little(2, 2) + little(0x12345678, 4) + rest);
  EXPECT_EQ(of(ask(REQUEST_FAULT, {0})), little(2, 2) + little(0x12345679, 4) + rest);
  EXPECT_EQ(ask(REQUEST_FAULT, {2}).status(), RANGE);
}

TEST_F(RequestFields, EveryErrorOfTheLinkHasItsPlace) {
  send(Octets{0, 9, 9, 9, 0} + Octets(300, 0x80));  // damaged, then too long
  run(400);
  for (int k = 0; k < 2; ++k) {
    send(Octets{0, 9, 0x80});
    run(1200);  // broken off
  }
  board.serial_errors = {0x0103, 0x0204, 0x0305, 0x0406};
  for (int k = 0; k < 5; ++k) stream_dropped(COMM_WATCHDOG_SERIAL);
  stream_dropped(COMM_WATCHDOG_BUS);
  for (int k = 0; k < 7; ++k) count_refusal();
  EXPECT_EQ(of(ask(REQUEST_LINK)), little(1, 2) + little(1, 2) + little(2, 2) + little(0x0103, 2) + little(0x0204, 2) +
                                       little(0x0305, 2) + little(0x0406, 2) + little(5, 2) + little(7, 2));
}

TEST_F(RequestFields, AsManySignalsAsThereMayBe) {
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20() = {-5, 0x12345678};
  inside::low_speed_estimate().angle_bam = 0x89ABCDEF;
  Octets places, values;
  for (const std::uint16_t place : {0, 5, 9, 10, 0, 5, 9, 10, 0, 5, 9, 10, 0, 5, 10, 9}) {
    places = places + little(place, 2);
    values = values + i32(inside::signal(place, drive_known(&drive)));
  }
  EXPECT_EQ(of(ask(REQUEST_SIGNALS, places)), values + Octets{3});
  EXPECT_EQ(ask(REQUEST_SIGNALS, little(signal_count() - 1u, 2)).body(), 5u);
}

// By a status of its own, wherever a request names it; that of another edition's signal is no place that there is not.
TEST_F(RequestFields, ASignalThatTheEditionHasNotIsRefused) {
  const bool has_scope = missing_of({"scope"}).empty();
  const Octets scope = little(1, 2) + little(0, 2) + Octets{SCOPE_SINGLE, SCOPE_RISING};
  for (std::uint16_t k = 0; k < signal_count(); ++k) {
    const std::string name = bench::text_of(signal_info(k)->name);
    const bool gone = ((name == "load_angle" || name == "magnet_flux") && !missing_of({"sources/flux"}).empty()) ||
                      (name == "wiring" && !missing_of({"start/flying"}).empty());
    const unsigned status = gone ? EDITION : OK;
    const Octets place = little(k, 2);
    EXPECT_EQ(ask(REQUEST_SIGNALS, little(0, 2) + place).status(), status) << name;
    EXPECT_EQ(ask(REQUEST_STREAM, little(0, 2) + little(0, 2) + place).status(), status) << name;
    EXPECT_EQ(ask(REQUEST_SIGNAL_INFO, place).status(), status) << name;
    if (!has_scope) continue;
    const Octets channel = Octets{1} + place + Octets{0}, first = Octets{1, 0, 0, 0};
    EXPECT_EQ(ask(REQUEST_SCOPE_SETUP, scope + place + i32(0) + first).status(), status) << name << ", trigger";
    EXPECT_EQ(ask(REQUEST_SCOPE_SETUP, scope + little(0, 2) + i32(0) + channel).status(), status) << name;
  }
}

TEST_F(RequestFields, EverySignalTellsAllOfItself) {
  for (std::uint16_t k = 0; k < signal_count(); ++k) {
    const signal_info_t& s = *signal_info(k);
    const Answer a = ask(REQUEST_SIGNAL_INFO, little(k, 2));
    ASSERT_EQ(a.status(), signal_is_left_out(k) ? EDITION : OK);
    if (signal_is_left_out(k)) continue;
    EXPECT_EQ(a.number(0, 1), s.q + 0x40u * (s.needs == KNOWN_HEAT_SINK ? 3u : s.needs));
    EXPECT_EQ(a.text(1), bench::text_of(s.name) + '\0' + bench::text_of(signal_unit(&s)) + '\0' +
                             bench::text_of(signal_meaning(&s)));
  }
  EXPECT_EQ(ask(REQUEST_SIGNAL_INFO, little(signal_count(), 2)).status(), RANGE);
}

TEST_F(RequestFields, ParametersAreReadFromAnyPlaceOn) {
  const auto read = [&](unsigned first, unsigned count) {
    return ask(REQUEST_PARAMETER_READ, little(first, 2) + little(count, 1));
  };
  const auto expected = [](unsigned first, unsigned count) {
    Octets octets;
    for (unsigned k = first; k < first + count; ++k) {
      const std::uint16_t id = parameter_info(static_cast<std::uint16_t>(k))->id;
      octets = octets + little(id, 2) + i32(parameter_get(id));
    }
    return octets;
  };
  const unsigned all = parameter_count();
  EXPECT_EQ(of(read(0, 32)), expected(0, 32));
  EXPECT_EQ(of(read(7, 3)), expected(7, 3));
  EXPECT_EQ(of(read(all - 2, 32)), expected(all - 2, 2)) << "there are no more";
  EXPECT_EQ(of(read(7, 0)), Octets());
  EXPECT_EQ(read(all, 1).status(), RANGE);
}

TEST_F(RequestFields, ResultsOfACommissioningAreToldWhole) {
  NEEDS("commissioning");
  commissioning.evaluate = true;
  commissioning_service(&drive);
  const std::uint16_t count = drive_commissioning_count();
  ASSERT_GT(count, 0);
  for (std::uint16_t k = 0; k < count; ++k) {
    const commissioning_result_t& r = *drive_commissioning_result(k);
    EXPECT_EQ(of(ask(REQUEST_COMMISSION_RESULT, little(k, 2))), little(count, 2) + little(r.id, 2) + i32(r.before) +
                                                                    i32(r.value) +
                                                                    Octets{static_cast<std::uint16_t>(r.verdict)});
  }
}

TEST_F(RequestFields, AScopeIsSetUpAsTold) {
  NEEDS("scope");
  const Octets head = little(0x0102, 2) + little(0x0103, 2), level = i32(-70000);
  const Octets channels = little(1, 1) + Octets{7, 0, 12};
  ASSERT_EQ(ask(REQUEST_SCOPE_SETUP, head + Octets{SCOPE_AUTO, SCOPE_BELOW, 4, 0} + level + channels).status(), OK);
  const scope_setup_t s = *scope_setup_in_force();
  EXPECT_EQ(s.decimation, 0x0102);
  EXPECT_EQ(s.pretrigger, 0x0103);
  EXPECT_EQ(s.mode, SCOPE_AUTO);
  EXPECT_EQ(s.edge, SCOPE_BELOW);
  EXPECT_EQ(s.trigger, 4);
  EXPECT_EQ(s.level, -70000);
  EXPECT_EQ(s.count, 1);
  EXPECT_EQ(s.channel[0].signal, 7);
  EXPECT_EQ(s.channel[0].shift, 12);
  for (const Octets& wrong : {Octets{SCOPE_AUTO + 1, 0, 4, 0}, Octets{0, SCOPE_BELOW + 1, 4, 0}}) {
    EXPECT_EQ(ask(REQUEST_SCOPE_SETUP, head + wrong + level + channels).status(), RANGE);
  }
  EXPECT_EQ(ask(REQUEST_SCOPE_SETUP, head + Octets{0, 0, 4, 0} + level + Octets{5} + Octets(15, 0)).status(), RANGE);
  EXPECT_EQ(s.hysteresis, SCOPE_BY_SPAN) << "when there is none";
  const Octets edge = head + Octets{0, SCOPE_RISING, 4, 0} + level + channels;
  ASSERT_EQ(ask(REQUEST_SCOPE_SETUP, edge + i32(80000)).status(), OK);
  EXPECT_EQ(scope_setup_in_force()->hysteresis, 80000);
  EXPECT_EQ(ask(REQUEST_SCOPE_SETUP, edge + Octets{1, 2}).status(), LENGTH);
}

TEST_F(RequestFields, AScopeTellsWhereItsTriggerWas) {
  NEEDS("scope");
  inside::be_in(DRIVE_RUN);
  EXPECT_EQ(ask(REQUEST_SCOPE_ARM).text(), "the scope is not set up yet");
  const Octets setup = little(1, 2) + little(300, 2) + Octets{SCOPE_SINGLE, SCOPE_AT_ONCE, 4, 0} + i32(0);
  ASSERT_EQ(ask(REQUEST_SCOPE_SETUP, setup + Octets{2, 9, 0, 0, 10, 0, 0}).status(), OK);
  ASSERT_EQ(ask(REQUEST_SCOPE_ARM).status(), OK);
  EXPECT_EQ(of(ask(REQUEST_SCOPE_STATE)), Octets{SCOPE_FILLING} + little(0, 2) + little(SCOPE_NOWHERE, 2) + i32(0));
  for (int k = 0; k < 2000; ++k) {
    inside::current_dq_q20() = {k, -k};
    inside::time_ms() = static_cast<std::uint32_t>(0x01020000 + k);
    if (drive_onlooker != nullptr) drive_onlooker();
  }
  EXPECT_EQ(of(ask(REQUEST_SCOPE_STATE)),
            Octets{SCOPE_DONE} + little(SCOPE_DEPTH, 2) + little(300, 2) + little(0x01020000 + 300, 4));
  EXPECT_EQ(of(ask(REQUEST_SCOPE_READ, Octets{1} + little(SCOPE_DEPTH - 1, 2) + Octets{100})),
            little(static_cast<std::uint32_t>(1 - int(SCOPE_DEPTH)), 2))
      << "the last one";
  EXPECT_EQ(of(ask(REQUEST_SCOPE_READ, Octets{0} + little(300, 2) + Octets{2})), little(300, 2) + little(301, 2));
  EXPECT_EQ(ask(REQUEST_SCOPE_READ, Octets{0} + little(SCOPE_DEPTH, 2) + Octets{1}).status(), RANGE);
  EXPECT_EQ(ask(REQUEST_SCOPE_READ, Octets{SCOPE_CHANNELS, 0, 0, 1}).status(), RANGE);
  ASSERT_EQ(ask(REQUEST_SCOPE_ARM).status(), OK);
  ASSERT_EQ(ask(REQUEST_SCOPE_STOP).status(), OK);
  EXPECT_EQ(ask(REQUEST_SCOPE_STATE).number(0, 1), static_cast<unsigned>(SCOPE_IDLE));
}

TEST_F(RequestFields, AStreamTakesItsSignalsInTheirOrder) {
  inside::be_in(DRIVE_RUN);
  Octets body = little(20, 2), values;
  inside::current_dq_q20() = {-5, 0x12345678};
  inside::low_speed_estimate().angle_bam = 0x89ABCDEF;
  for (const std::uint16_t place : {9, 10, 5, 0, 9, 5, 10, 9}) {
    body = body + little(place, 2);
    values = values + i32(inside::signal(place, drive_known(&drive)));
  }
  ASSERT_EQ(ask(REQUEST_STREAM, body).status(), OK);
  records.clear();
  run(200);
  ASSERT_EQ(records.size(), 1u);
  EXPECT_EQ(Octets(records[0].begin() + 6, records[0].end()), values + Octets{3});
}

}  // namespace
