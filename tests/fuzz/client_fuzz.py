"""Searches with a generator for octets that break the virtual board's SLCAN adapter or the client's readers.

The properties and the generator are tests/python/any_octets.py. Usage: client_fuzz.py RUNS [SEED]; RUNS of the adapter
and RUNS of the readers together. The first input that breaks something is printed.
"""

import random
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

import any_octets


def search(name: str, checks: tuple, runs: int, seed: int) -> None:
    """`runs` inputs to these checks in turn."""
    source = random.Random(seed)
    began = time.monotonic()
    for number in range(runs):
        octets = any_octets.some_octets(source)
        check = checks[number % len(checks)]
        try:
            check(octets)
        except Exception:
            print(f"fuzz: {check.__name__} fails on bytes.fromhex({octets.hex()!r})", file=sys.stderr)
            raise
    print(f"fuzz: {name}, {runs} runs clean, {runs / (time.monotonic() - began):.0f} per second")


def main() -> None:
    """See above."""
    runs = int(sys.argv[1])
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else random.SystemRandom().randrange(2**32)
    print(f"fuzz: client and SLCAN adapter, seed {seed}")
    search("SLCAN adapter", (any_octets.slcan,), runs, seed)
    search("client", any_octets.CHECKS[1:], runs, seed)


if __name__ == "__main__":
    main()
