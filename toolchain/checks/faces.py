"""A header of firmware/ is small: six others of firmware/ at most, 150 lines at most.

Who includes it knows all that it includes. What is larger still stands in LEFT, which only shrinks.
"""

from pathlib import Path

from checks import Finding, left
from checks.preprocessor import directives

MOST_INCLUDES = 6
MOST_LINES = 150
LEFT = "toolchain/faces_left.txt"


def _too_large(text: str) -> dict[str, str]:
    """What is too large of it, and what to do."""
    included = [d for d in directives(text) if d.name == "include" and d.rest[1:].startswith("firmware/")]
    count = len(text.splitlines())
    found = {}
    if len(included) > MOST_INCLUDES:
        found["includes"] = f"{len(included)} headers of firmware/ included, {MOST_INCLUDES} are the most: split it"
    if count > MOST_LINES:
        found["lines"] = f"{count} lines, {MOST_LINES} are the most of a header: split it"
    return found


def check(root: Path) -> list[Finding]:
    """Findings for headers that are too large, and for exceptions that nothing needs."""
    borne = left(root / LEFT)
    headers = {p.relative_to(root).as_posix(): p for p in sorted((root / "firmware").rglob("*.h")) if p.is_file()}
    large = {
        (source, what): message
        for source, path in headers.items()
        for what, message in _too_large(path.read_text(encoding="utf-8")).items()
    }
    findings = [Finding(source, 0, message) for (source, what), message in large.items() if (source, what) not in borne]
    stale = {place: line for place, line in borne.items() if place not in large}
    return findings + [
        Finding(LEFT, n, f"{source} is small in {what}: take it out") for (source, what), n in stale.items()
    ]
