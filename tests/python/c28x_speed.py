"""How fast code runs on the virtual chip with its peripherals attached: two seconds of the control program.

A program to look at, not a test: machines differ.
"""

import time

from c28x_chip import MILLISECOND, ask, program, put

SECONDS = 2


def main():
    commands = [*put(program("control").words), f"run {SECONDS * 1000 * MILLISECOND:x}", "cycles"]
    began = time.perf_counter()
    (counts,) = ask(commands)
    wall = time.perf_counter() - began
    instructions = int(counts.split()[1])
    print(f"{instructions / wall * 1e-6:.1f} million instructions/s, {SECONDS / wall:.1f} × real time")


if __name__ == "__main__":
    main()
