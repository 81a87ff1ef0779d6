// Every packed text is the one in its list, and the words of every code are those of its row.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "sim_host/bench/texts.hpp"
#include "tests/firmware/edition.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "firmware/text/text.h"
}

namespace stillspin::test {
namespace {

using bench::text_of;
using bench::words_of;

struct Row {
  packed_text_t number;
  std::string text;
};

#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) \
  {TEXT_PARAMETER_##name, meaning}, {TEXT_PARAMETER_NAME_##name, #name},
#define SIGNAL(name, unit, q, of, value, meaning) {TEXT_SIGNAL_##name, meaning}, {TEXT_SIGNAL_NAME_##name, #name},
#define UNIT(unit, text, current, voltage) {TEXT_UNIT_##unit, text},
#define FAULT(number, name, words, remedy) {TEXT_FAULT_##number, words}, {TEXT_REMEDY_##number, remedy},
#define WORDS(kind, code, text) {TEXT_##kind##_##code, text},
#define COMMAND(name, arguments, help) \
  {TEXT_COMMAND_##name, help}, {TEXT_COMMAND_NAME_##name, #name}, {TEXT_COMMAND_ARGUMENTS_##name, arguments},
#define HELP(command, number, text) {TEXT_HELP_##command##_##number, text},
#define PHRASE(name, text) {SAY_##name, text},
const Row kListed[] = {
#include "firmware/board/phrase_list.h"
#include "firmware/can/phrase_list.h"
#include "firmware/commissioning/phrase_list.h"
#include "firmware/config/phrase_list.h"
#include "firmware/console/all_commands.h"
#include "firmware/console/all_help.h"
#include "firmware/console/phrase_list.h"
#include "firmware/console/suggest/phrase_list.h"
#include "firmware/dictionary/all_faults.h"
#include "firmware/dictionary/all_parameters.h"
#include "firmware/dictionary/all_signals.h"
#include "firmware/dictionary/unit_list.h"
#include "firmware/hil/phrase_list.h"
#include "firmware/hysteresis/phrase_list.h"
#include "firmware/link/phrase_list.h"
#include "firmware/scope/phrase_list.h"
#include "firmware/sources/flux/phrase_list.h"
#include "firmware/sources/paper/phrase_list.h"
#include "firmware/start/if_start/phrase_list.h"
#include "firmware/store/phrase_list.h"
#include "firmware/text/catalogue_list.h"
#include "firmware/text/phrase_list.h"
};
#undef PARAMETER
#undef SIGNAL
#undef UNIT
#undef FAULT
#undef WORDS
#undef COMMAND
#undef HELP
#undef PHRASE

// Those that the edition has; of one that leaves features out, what it never says is empty.
std::vector<Row> of_the_edition() {
  std::vector<Row> rows;
  for (const Row& row : kListed) {
    if (features_left_out[0] == nullptr || !packed_is_empty(row.number)) rows.push_back(row);
  }
  return rows;
}
const std::vector<Row> kRows = of_the_edition();

bool occurs(packed_text_t text, const std::string& part) {
  const std::vector<std::uint16_t> wanted(part.begin(), part.end());
  return packed_occurs(text, wanted.data(), static_cast<std::uint16_t>(wanted.size()));
}

TEST(PackedText, EveryTextIsTheOneInItsList) {
  ASSERT_EQ(std::size(kListed), static_cast<std::size_t>(PACKED_TEXTS));
  for (const Row& row : kRows) EXPECT_EQ(text_of(row.number), row.text);
}

bool equals(packed_text_t text, const std::string& other) {
  const std::vector<std::uint16_t> wanted(other.begin(), other.end());
  return packed_equals(text, wanted.data(), static_cast<std::uint16_t>(wanted.size()));
}

TEST(PackedText, EqualsItselfAlone) {
  for (const Row& row : kRows) {
    EXPECT_TRUE(equals(row.number, row.text));
    EXPECT_FALSE(equals(row.number, row.text + "~"));
    EXPECT_FALSE(equals(row.number, row.text + std::string(1, '\0'))) << "the end is no character";
    EXPECT_EQ(packed_is_empty(row.number), row.text.empty());
    if (row.text.empty()) continue;
    EXPECT_FALSE(equals(row.number, row.text.substr(1)));
    EXPECT_FALSE(equals(row.number, row.text.substr(0, row.text.size() - 1)));
  }
  EXPECT_TRUE(equals(TEXT_UNIT_OHM, "OHM"));
}

std::uint16_t place_of(packed_text_t first, std::uint16_t texts, const std::string& name) {
  std::vector<std::uint16_t> wanted;
  for (const char c : name) wanted.push_back(static_cast<unsigned char>(c));
  return packed_find(first, texts, wanted.data(), static_cast<std::uint16_t>(wanted.size()));
}

TEST(PackedText, ANameIsFoundByItself) {
  const packed_text_t first = TEXT_PARAMETER_NAME_pole_pairs;
  const std::uint16_t names = TEXT_SIGNAL_NAME_state - TEXT_PARAMETER_NAME_pole_pairs;
  for (std::uint16_t k = 0; k < names; ++k) {
    EXPECT_EQ(place_of(first, names, text_of(first + k)), k);
    EXPECT_EQ(place_of(first, names, text_of(first + k) + "~"), names);
  }
  EXPECT_EQ(place_of(first, names, ""), names);
  EXPECT_EQ(place_of(first, names, "Stator_RESISTANCE"), TEXT_PARAMETER_NAME_stator_resistance - first);
  EXPECT_EQ(place_of(first, TEXT_PARAMETER_NAME_stator_resistance - first, "stator_resistance"),
            TEXT_PARAMETER_NAME_stator_resistance - first)
      << "behind the last that is looked at";
  EXPECT_EQ(place_of(TEXT_SIGNAL_NAME_state, signal_count(), "speed"), TEXT_SIGNAL_NAME_speed - TEXT_SIGNAL_NAME_state);
  EXPECT_EQ(place_of(first, names, "stator_resistanb\x84"), names) << "the key of stator_resistance: 31 'c' + 'e'";
}

TEST(PackedText, PartsAreFound) {
  for (const Row& row : kRows) {
    EXPECT_TRUE(occurs(row.number, ""));
    EXPECT_TRUE(occurs(row.number, row.text));
    EXPECT_FALSE(occurs(row.number, row.text + "~"));
    EXPECT_FALSE(occurs(row.number, row.text + std::string(1, '\0'))) << "the end is no character";
    for (std::size_t at = 0; at + 3 < row.text.size(); ++at) EXPECT_TRUE(occurs(row.number, row.text.substr(at, 4)));
  }
  EXPECT_TRUE(occurs(TEXT_PARAMETER_stator_resistance, "RESISTANCE of"));
  EXPECT_FALSE(occurs(TEXT_PARAMETER_stator_resistance, "inductance"));
}

TEST(PackedText, WhatIsTooLongForTheBlockIsCutOffAndSaysSo) {
  std::uint16_t block[5] = {0, 0, 0, 0, '#'};
  octet_writer_t writer = octet_writer(block, 4);
  put_packed(&writer, TEXT_PARAMETER_inertia);
  EXPECT_TRUE(writer.full);
  EXPECT_EQ(writer.count, 4);
  EXPECT_EQ(block[4], '#');
}

void expect_words(catalogue_t kind, std::uint16_t code, const char* text) {
  EXPECT_EQ(words_of(kind, code), message_is_left_out(kind, code) ? "?" : text);
}

TEST(Words, AreThoseOfTheirKindAndCode) {
#define WORDS(kind, code, text) expect_words(CATALOGUE_##kind, code, text);
#include "firmware/text/catalogue_list.h"
#undef WORDS
#define FAULT(number, name, words, remedy)      \
  expect_words(CATALOGUE_FAULT, number, words); \
  expect_words(CATALOGUE_REMEDY, number, remedy);
#include "firmware/dictionary/all_faults.h"
#undef FAULT
}

TEST(Words, NoneForWhatDoesNotExist) {
  for (std::uint16_t kind = 0; kind < CATALOGUES; ++kind) {
    std::uint16_t codes = 0;
    while (message_exists(kind, codes)) codes++;
    EXPECT_GT(codes, message_is_left_out(kind, 0) ? -1 : 4) << kind;
    for (const std::uint16_t code : {int{codes}, 255, 0x7FFF, 0xFFFF}) {
      EXPECT_FALSE(message_exists(kind, static_cast<std::uint16_t>(code))) << kind;
      EXPECT_EQ(words_of(static_cast<catalogue_t>(kind), static_cast<std::uint16_t>(code)), "?");
    }
  }
  EXPECT_FALSE(message_exists(CATALOGUES, 0));
  EXPECT_FALSE(message_exists(0xFFFF, 0));
}

}  // namespace
}  // namespace stillspin::test
