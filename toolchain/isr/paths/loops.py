"""Loops of a function: a block that is on every way to where something jumps back to it from, and what lies between."""

from collections import defaultdict
from dataclasses import dataclass

from isr.paths.program import Function


@dataclass(frozen=True)
class Loop:
    """A loop with one entry, its head."""

    head: int
    body: frozenset[int]
    tails: frozenset[int]  # blocks that jump back

    def asks_last(self, function: Function) -> bool:
        """Whether every way out is where it jumps back, so that no block runs more often than the loop goes round."""
        inner = self.body - self.tails
        return all(to in self.body for block in inner for to in function.blocks[block].successors)


def in_order(function: Function) -> list[int]:
    """The blocks, each before those that it leads to, jumps back left out of account."""
    seen = {function.entry}
    order: list[int] = []
    stack = [(function.entry, iter(function.blocks[function.entry].successors))]
    while stack:
        block, successors = stack[-1]
        for to in successors:
            if to not in seen:
                seen.add(to)
                stack.append((to, iter(function.blocks[to].successors)))
                break
        else:
            order.append(block)
            stack.pop()
    return order[::-1]


def _dominators(order: list[int], before: dict[int, list[int]]) -> dict[int, int]:
    """The last block that every way to a block goes through (Cooper, Harvey, Kennedy)."""
    place = {block: k for k, block in enumerate(order)}
    last = {order[0]: order[0]}

    def common(a: int, b: int) -> int:
        while a != b:
            while place[a] > place[b]:
                a = last[a]
            while place[b] > place[a]:
                b = last[b]
        return a

    changed = True
    while changed:
        changed = False
        for block in order[1:]:
            known = [p for p in before[block] if p in last]
            new = known[0]
            for p in known[1:]:
                new = common(p, new)
            if last.get(block) != new:
                last[block], changed = new, True
    return last


def loops_of(function: Function) -> list[Loop]:
    """All loops, inner ones first. ValueError where a loop has two entries."""
    order = in_order(function)
    place = {block: k for k, block in enumerate(order)}
    before: dict[int, list[int]] = defaultdict(list)
    for block in order:
        for to in function.blocks[block].successors:
            before[to].append(block)
    last = _dominators(order, before)
    tails: dict[int, set[int]] = defaultdict(set)
    for block in order:
        for to in function.blocks[block].successors:
            if place[to] > place[block]:
                continue
            above = block
            while above not in (to, function.entry):
                above = last[above]
            if above != to:
                raise ValueError(f"{function.name}: a loop with two entries at {to:x}")
            tails[to].add(block)
    found = []
    for head, ends in tails.items():
        body, waiting = {head}, list(ends)
        while waiting:
            block = waiting.pop()
            if block not in body:
                body.add(block)
                waiting += before[block]
        found.append(Loop(head, frozenset(body), frozenset(ends)))
    return sorted(found, key=lambda loop: len(loop.body))
