"""The longest path through a program, by its facts: a bound of the instructions that can run.

A loop counts as often as its fact says, its longest round each time; a call counts the longest path of what it calls.
Of what may and may not come after each other in different places nothing is known but what the facts say.
"""

from collections import Counter
from dataclasses import dataclass, field

from isr.paths.facts import Facts
from isr.paths.loops import Loop, in_order, loops_of
from isr.paths.program import BY_POINTER, Block, Function, Program, fact_on, plain, shared

ACCESS = "target_"  # a register access counts as the one instruction that calls it
NO_INSTRUCTION = "target_elapse"  # nothing on the chip
_NEVER = -(10**9)


@dataclass
class Way:
    """A longest path: its instructions, and where they come from."""

    cost: int
    parts: Counter[str] = field(default_factory=Counter)

    @property
    def is_possible(self) -> bool:
        """Whether there is a path at all."""
        return self.cost >= 0


IMPOSSIBLE = Way(_NEVER)


def total(a: Way, b: Way, times: int = 1) -> Way:
    """One after the other, the second several times."""
    if not (a.is_possible and b.is_possible):
        return IMPOSSIBLE
    parts = Counter(a.parts)
    for name, count in b.parts.items():
        parts[name] += times * count
    return Way(a.cost + times * b.cost, parts)


def longer(a: Way, b: Way) -> Way:
    """The one with more instructions."""
    return a if a.cost >= b.cost else b


class Bound:
    """Longest paths with one choice of what does not run."""

    def __init__(self, program: Program, facts: Facts, left_out: set[str]) -> None:
        """Of a program, by the facts of a mode."""
        self.program, self.facts, self.left_out = program, facts, left_out
        self._ways: dict[str, Way] = {}
        self._loops: dict[str, list[Loop]] = {}

    def loops(self, function: Function) -> list[Loop]:
        """Its loops, inner ones first."""
        if function.name not in self._loops:
            self._loops[function.name] = loops_of(function)
        return self._loops[function.name]

    def rounds(self, function: Function, loop: Loop) -> int:
        """How often it jumps back. ValueError where no fact says so."""
        own = shared(frames for at in loop.body for frames in function.blocks[at].frames)
        often = fact_on(own, self.facts.loops)
        if often is None:
            raise ValueError(f"no fact on the loop at {loop.head:x} of {function.name}, {own}")
        return max(often - 1, 0) if loop.asks_last(function) else often

    def callees(self, block: Block, function: str) -> set[str]:
        """Whom the end of a block may call. ValueError where no fact says so."""
        if block.call != BY_POINTER:
            return {block.call}
        own = block.frames[-1][0]
        words = fact_on(own, self.facts.calls)
        if words is None:
            place = f"{block.instructions[-1]:x} of {function}, {own}"
            raise ValueError(f"no fact on the call through a pointer at {place}")
        found = set()
        for word in words:
            reached = self.program.table(word[1:]) if word.startswith("@") else self._named(word)
            if not reached:
                raise ValueError(f"{function} calls {word} through a pointer: there is no such function")
            found |= reached
        return found

    def _named(self, name: str) -> set[str]:
        return {linked for linked in self.program.code if plain(linked) == name}

    def cost_of(self, block: Block, function: str, *, inside: frozenset[str] = frozenset()) -> Way:
        """A block with what it calls; what it calls in `inside` is left out."""
        if block.is_of(self.left_out):
            return IMPOSSIBLE
        parts: Counter[str] = Counter()
        for frames in block.frames:
            parts[frames[0].function] += 1
        own = Way(len(block.instructions), parts)
        if not block.call:
            return own
        if block.call.startswith(ACCESS):
            return Way(own.cost - 1, parts) if block.call == NO_INSTRUCTION else own
        called = self.callees(block, function)
        best = own if called & inside else IMPOSSIBLE
        for callee in sorted(called - inside):
            best = longer(best, total(own, self.of_function(callee)))
        return best

    def of_function(self, name: str) -> Way:
        """The longest path from a function's entry to its end."""
        if name not in self._ways:
            function = self.program.function(name)
            weights = self._weights(function, frozenset())
            best = IMPOSSIBLE
            for address, way in self._longest(function, weights).items():
                best = longer(best, way) if function.blocks[address].returns else best
            self._ways[name] = best
        return self._ways[name]

    def _weights(self, function: Function, inside: frozenset[str]) -> dict[int, Way]:
        """What each block counts; the head of a loop with all its rounds but the last."""
        weights = {at: self.cost_of(block, function.name, inside=inside) for at, block in function.blocks.items()}
        for loop in self.loops(function):
            ways = self._longest(function, weights, loop)
            best = IMPOSSIBLE
            for tail in loop.tails:
                best = longer(best, ways.get(tail, IMPOSSIBLE))
            if best.is_possible:
                weights[loop.head] = total(weights[loop.head], best, self.rounds(function, loop))
        return weights

    def _longest(self, function: Function, weights: dict[int, Way], loop: Loop | None = None) -> dict[int, Way]:
        """The longest path to the end of each block, from the entry, or within a loop from its head."""
        order = in_order(function)
        place = {block: k for k, block in enumerate(order)}
        start = loop.head if loop else function.entry
        ways: dict[int, Way] = {start: weights[start]}
        for block in order:
            if block not in ways or (loop and block not in loop.body):
                continue
            for to in function.blocks[block].successors:
                if place[to] <= place[block] or (loop and to not in loop.body):
                    continue
                way = total(ways[block], weights[to])
                if way.is_possible:
                    ways[to] = longer(ways.get(to, IMPOSSIBLE), way)
        return {block: way for block, way in ways.items() if way.is_possible}

    def ends_step(self, block: Block) -> bool:
        """Whether the call at the end of a block ends a step of the interrupt: who calls it above the HAL decides."""
        callers = (frame.function for frame in block.frames[-1] if not frame.function.startswith("hal_"))
        return block.call == NO_INSTRUCTION and next(callers, "") in self.facts.step_ends

    def weights_beside(self, function: Function, inside: frozenset[str]) -> dict[int, Way]:
        """What each block counts with all that it calls but `inside`. ValueError where a loop calls one of those."""
        for loop in self.loops(function):
            if any(function.blocks[at].call in inside for at in loop.body):
                raise ValueError(f"{function.name}: the loop at {loop.head:x} calls what ends a step")
        return self._weights(function, inside)
