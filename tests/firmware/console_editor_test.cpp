// The line editor: keys, history, what the terminal shows.

#include "tests/firmware/terminal.hpp"

extern "C" {
#include "firmware/console/editor.h"
}

namespace {

using namespace stillspin::test;

class Editor : public testing::Test {
 protected:
  void SetUp() override { editor_reset(&e); }

  std::string type(const std::string& keys) {
    std::string done;
    for (const char c : keys) {
      Octets block(EDITOR_ECHO_MAX);
      octet_writer_t echo = octet_writer(block.data(), EDITOR_ECHO_MAX);
      const editor_event_t event = editor_octet(&e, static_cast<std::uint8_t>(c), &echo);
      EXPECT_FALSE(echo.full);
      for (int k = 0; k < echo.count; ++k) show(static_cast<char>(block[std::size_t(k)]));
      if (event == EDITOR_NOTHING) continue;
      done += (event == EDITOR_DONE) ? std::string(e.line.text, e.line.text + e.line.count) + "|" : "^|";
      editor_next(&e);
      screen = "> ";
      column = 2;
    }
    return done;
  }

  void show(char c) {
    if (escape > 0) {
      if (--escape == 0 && c == 'K') screen.resize(column);
    } else if (c == '\x1B') {
      escape = 2;
    } else if (c == '\b') {
      column--;
    } else if (c == '\r') {
      column = 0;
    } else if (c >= ' ') {
      screen.resize(std::max(screen.size(), column + 1), ' ');
      screen[column++] = c;
    }
  }

  editor_t e;
  std::string screen = "> ";
  std::size_t column = 2;
  int escape = 0;
};

TEST_F(Editor, LinesAndTheirEnds) { EXPECT_EQ(type("a\rb\nc\r\nd\r\r\n"), "a|b|c|d||"); }

TEST_F(Editor, ACursorBehindTheLineIsAtItsEnd) {
  (void)type("ab");
  e.cursor = EDITOR_LINE + 1u;
  EXPECT_EQ(type("c\r"), "abc|");
}

TEST_F(Editor, KeysMoveAndChange) {
  type("helo\x1B[D\x1B[Dl");
  EXPECT_EQ(screen, "> hello");
  EXPECT_EQ(column, 5u);
  type("\x1B[H>\x1B[F<");
  EXPECT_EQ(screen, "> >hello<");
  type("\b\x7F");
  EXPECT_EQ(screen.substr(0, 8), "> >hell ");
  EXPECT_EQ(column, 7u);
  type("\x01\x1B[3~");
  EXPECT_EQ(screen, "> hell");
  EXPECT_EQ(type("\x05p\r"), "hellp|");
  type("abc\x15");
  EXPECT_EQ(screen, "> ");
  EXPECT_EQ(type("\r"), "|");
}

TEST_F(Editor, KeysThatItDoesNotKnowDoNothing) {
  type("abc\x1B[H");
  for (const char* key : {"\x1B[5~", "\x1B[6~", "\x1B[2~", "\x1B[15~", "\x1B[1;5Z"}) type(key);
  EXPECT_EQ(screen, "> abc");
  EXPECT_EQ(column, 2u);
  EXPECT_EQ(type("\x1B[3~\r"), "bc|") << "delete, which ends like them";
}

TEST_F(Editor, TheTerminalShowsTheLineWhateverIsTyped) {
  const char* const keys[] = {"a",      "b",      "\b",     "\x1B[C",  "\x1B[D", "\x1B[A",
                              "\x1B[B", "\x1B[H", "\x1B[F", "\x1B[3~", "xy",     "\x15"};
  unsigned random = 1;
  for (int k = 0; k < 20000; ++k) {
    random = random * 1664525u + 1013904223u;
    type((random >> 16) % 97 == 0 ? "\r" : keys[(random >> 16) % 12]);
    std::string shown = screen;
    shown.resize(std::max<std::size_t>(2, shown.find_last_not_of(' ') + 1));
    ASSERT_EQ(shown, "> " + std::string(e.line.text, e.line.text + e.line.count));
    ASSERT_EQ(column, 2u + e.cursor);
  }
}

TEST_F(Editor, HistoryOfTheLastFourLines) {
  type("one\rtwo\rtwo\rthree\rfour\rfive\r");
  EXPECT_EQ(type("\x1B[A\x1B[A\x1B[A\r"), "three|");
  EXPECT_EQ(type("\x1B[A\x1B[A\x1B[A\x1B[A\x1B[A\x1B[A\r"), "three|") << "now the oldest";
  EXPECT_EQ(type("\x1B[A\x1B[B\r"), "|");
}

TEST_F(Editor, NoiseIsIgnored) {
  EXPECT_EQ(type("\xFF\x01\x02\x04s\x0Ft\x1Bxop\r"), "stop|") << "an escape that begins nothing takes one character";
}

TEST_F(Editor, CtrlC) {
  EXPECT_EQ(type("abc\x03"
                 "d\r"),
            "^|d|");
}

TEST_F(Editor, TheEndOfALine) {
  type(std::string(EDITOR_LINE, 'x'));
  EXPECT_FALSE(e.too_long);
  type("\x1B[Dy");
  EXPECT_TRUE(e.too_long);
  EXPECT_EQ(e.line.count, EDITOR_LINE);
  type("\r");
  EXPECT_FALSE(e.too_long);
}

// A terminal's keys begin with ESC [ and end with a character from @ on; what stands between belongs to them.
TEST_F(Editor, ASequenceEndsWithItsFinalCharacter) {
  for (int final = '@'; final <= '~'; ++final) {
    editor_reset(&e);
    EXPECT_EQ(type("\x1B[" + std::string(1, static_cast<char>(final)) + "x\r"), "x|") << final;
  }
  for (int between = ' '; between < '@'; ++between) {
    EXPECT_EQ(type("\x1B[" + std::string(1, static_cast<char>(between)) + "Zx\r"), "x|") << between;
  }
}

// What is left of a line that was cut twice is still the rest of one.
TEST_F(Editor, ASecondCutLeavesTheFirst) {
  (void)type("start");
  editor_cut(&e, false);
  EXPECT_TRUE(e.cut);
  editor_cut(&e, false);
  EXPECT_TRUE(e.cut);
  editor_reset(&e);
  editor_cut(&e, false);
  EXPECT_FALSE(e.cut) << "there was nothing to cut";
}

}  // namespace
