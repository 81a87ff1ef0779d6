// The vectors on an ATmega1284P: over its serial port, then asleep for ever, which ends simavr.

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include "tests/vectors/vectors.h"

void put_char(char c) {
  while ((UCSR0A & (1 << UDRE0)) == 0) {
  }
  UDR0 = (unsigned char)c;
}

int main(void) {
  UCSR0B = 1 << TXEN0;
  run_vectors();
  while ((UCSR0A & (1 << UDRE0)) == 0) {
  }
  cli();
  sleep_enable();
  sleep_cpu();
  return 0;
}
