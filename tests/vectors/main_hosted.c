// The vectors where there is a C library: on this computer, and on a Cortex-M by semihosting.

#include <stdio.h>

#include "tests/vectors/vectors.h"

void put_char(char c) { (void)putchar(c); }

int main(void) {
  run_vectors();
  return 0;
}
