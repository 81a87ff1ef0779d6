// The program's main, called by the C run-time. What is marked to run from RAM is linked to where it is loaded.

#include "firmware/lamp/lamp.h"

int main(void) {
  lamp_main();
  return 0;
}
