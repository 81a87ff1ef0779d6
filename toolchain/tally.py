#!/usr/bin/env python3
"""The last lines of `make test`: every test that was skipped, with its reason, and how many there were of which kind.

Usage: toolchain/tally.py FILE...      results as JUnit XML, of ctest and pytest

Tests that are about a feature rest in an edition that is without it. For ctest an edition is one case, Edition.NAME;
what its program wrote itself, editions/firmware_test_NAME.xml beside FILE, stands for it. They are said by edition
and feature, suite by suite, for they are hundreds.
"""

import re
import sys
import xml.etree.ElementTree as Xml
from collections import Counter
from pathlib import Path

_PLACE = re.compile(r"^\S+:\d+ ")  # where a test of C++ was skipped


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


def tests_of_edition(file: Path, case: Xml.Element) -> list[Xml.Element]:
    """The tests that a case of ctest stands for, where it is a whole edition and all of them went well."""
    name = title(case)
    own = file.parent / "editions" / f"firmware_test_{name.removeprefix('Edition.')}.xml"
    if not name.startswith("Edition.") or outcome(case) != "passed" or not own.is_file():
        return []
    return list(Xml.parse(own).iter("testcase"))


def not_for(edition: str, tests: list[Xml.Element]) -> list[str]:
    """A line for each feature that the edition is without: how many tests rest, and of which suites how many."""
    suites: dict[str, Counter[str]] = {}
    for test in (test for test in tests if outcome(test) == "skipped"):
        why = _PLACE.sub("", reason(test))
        suites.setdefault(why, Counter())[test.get("classname", "")] += 1
    return [
        f"skipped in {edition}, {sum(found.values())} of {len(tests)}: {why}: "
        + ", ".join(f"{suite} {count}" for suite, count in sorted(found.items()))
        for why, found in sorted(suites.items())
    ]


def lines(files: list[Path]) -> list[str]:
    """What is to be said of these results; a file that is not there belongs to tests that did not run at all."""
    said, count = [], Counter({"passed": 0, "failed": 0, "skipped": 0})
    for file in files:
        if not file.is_file():
            said.append(f"no results: {file}")
            continue
        for case in Xml.parse(file).iter("testcase"):
            of_edition = tests_of_edition(file, case)
            count.update(map(outcome, of_edition or [case]))
            if of_edition:
                said += not_for(title(case), of_edition)
            elif outcome(case) == "skipped":
                said.append(f"skipped: {title(case)}: {reason(case)}")
    said.append(", ".join(f"{number} {word}" for word, number in count.items()))
    return said


if __name__ == "__main__":
    print("\n".join(lines([Path(name) for name in sys.argv[1:]])))
