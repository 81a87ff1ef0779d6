#!/usr/bin/env python3
"""The last lines of `make test`: every test that was skipped, with its reason, and how many there were of which kind.

Usage: toolchain/tally.py FILE...      results as JUnit XML, of ctest and pytest
"""

import sys
import xml.etree.ElementTree as Xml
from collections import Counter
from pathlib import Path


def outcome(case: Xml.Element) -> str:
    """passed, failed or skipped."""
    if case.find("failure") is not None or case.find("error") is not None or case.get("status") == "fail":
        return "failed"
    return "passed" if case.find("skipped") is None and case.get("status", "run") == "run" else "skipped"


def title(case: Xml.Element) -> str:
    """The test's file or suite and its name; a test that is a whole file has but one of them."""
    suite, name = case.get("classname", ""), case.get("name", "")
    return suite if not name else name if suite in {"", name} else f"{suite}::{name}"


def reason(case: Xml.Element) -> str:
    """Why it was skipped, in one line."""
    skipped = case.find("skipped")
    words = (skipped.get("message") if skipped is not None else None) or case.get("status") or "no reason given"
    if words == "collection skipped" and skipped is not None:  # a whole file: why is further below
        words = (skipped.text or words).rpartition("Skipped: ")[2].rstrip("')")
    return " ".join(words.split())


def lines(files: list[Path]) -> list[str]:
    """What is to be said of these results; a file that is not there belongs to tests that did not run at all."""
    said, count = [], Counter({"passed": 0, "failed": 0, "skipped": 0})
    for file in files:
        if not file.is_file():
            said.append(f"no results: {file}")
            continue
        for case in Xml.parse(file).iter("testcase"):
            count[outcome(case)] += 1
            if outcome(case) == "skipped":
                said.append(f"skipped: {title(case)}: {reason(case)}")
    said.append(", ".join(f"{number} {word}" for word, number in count.items()))
    return said


if __name__ == "__main__":
    print("\n".join(lines([Path(name) for name in sys.argv[1:]])))
