"""The longest path through each step of an interrupt; the steps end in several of its functions."""

from collections import defaultdict

from isr.paths.bound import ACCESS, IMPOSSIBLE, Bound, Way, longer, total
from isr.paths.loops import in_order
from isr.paths.program import Block

Place = tuple[str, int]  # function, block


class Steps:
    """An interrupt and those of its functions in which steps end, as one graph of blocks without jumps back."""

    def __init__(self, bound: Bound, root: str) -> None:
        """Every other function that these call is one cost. ValueError where a step ends in what is called twice."""
        self.bound = bound
        self.weights: dict[Place, Way] = {}
        self.next: dict[Place, list[Place]] = defaultdict(list)
        self.ends: set[Place] = set()
        self._callers: dict[str, Place] = {}
        self._has_ends: dict[str, bool] = {}
        self._find_ends(root)
        self._inside = frozenset(name for name, has in self._has_ends.items() if has) | {root}
        self.entry = (root, bound.program.function(root).entry)
        for name in sorted(self._inside):
            self._add(name)
        self.last = self._lasts(root)

    def _find_ends(self, name: str) -> bool:
        """Whether a step ends in a function or in what it calls; notes it of all of these."""
        if name in self._has_ends:
            return self._has_ends[name]
        self._has_ends[name] = False
        for block in self.bound.program.function(name).blocks.values():
            if not block.call or block.is_of(self.bound.left_out):
                continue
            if block.call.startswith(ACCESS):
                self._has_ends[name] |= self.bound.ends_step(block)
                continue
            for callee in sorted(self.bound.callees(block, name)):
                self._has_ends[name] |= self._find_ends(callee)
        return self._has_ends[name]

    def _add(self, name: str) -> None:
        """The blocks of a function, and the ways into what it calls and back."""
        function = self.bound.program.function(name)
        place = {at: k for k, at in enumerate(in_order(function))}
        self.weights.update(((name, at), way) for at, way in self.bound.weights_beside(function, self._inside).items())
        for at, block in function.blocks.items():
            here = (name, at)
            if not self.weights[here].is_possible:
                continue
            on = [(name, to) for to in block.successors if place[to] > place[at]]
            if self.bound.ends_step(block):
                self.ends.add(here)
            inner = self._called_inside(name, block)
            if not inner or self.bound.callees(block, name) - inner:
                self.next[here] += on
            for callee in sorted(inner):
                if self._callers.setdefault(callee, here) != here:
                    raise ValueError(f"{callee} ends a step and is called by {self._callers[callee][0]} and by {name}")
                called = self.bound.program.function(callee)
                self.next[here].append((callee, called.entry))
                for back in self._lasts(callee):
                    self.next[back] += on

    def _called_inside(self, name: str, block: Block) -> set[str]:
        is_access = block.call.startswith(ACCESS)
        return self.bound.callees(block, name) & self._inside if block.call and not is_access else set()

    def _lasts(self, name: str) -> set[Place]:
        """The blocks with which a function ends, or what it ends with a jump to."""
        found: set[Place] = set()
        for at, block in self.bound.program.function(name).blocks.items():
            if block.returns and not block.is_of(self.bound.left_out):
                inner = self._called_inside(name, block)
                found |= set().union(*map(self._lasts, inner)) if inner else {(name, at)}
        return found

    def _order(self) -> list[Place]:
        """Each block before those that it leads to."""
        seen = {self.entry}
        order: list[Place] = []
        stack = [(self.entry, iter(self.next[self.entry]))]
        while stack:
            here, successors = stack[-1]
            to = next((to for to in successors if to not in seen), None)
            if to is None:
                order.append(here)
                stack.pop()
            else:
                seen.add(to)
                stack.append((to, iter(self.next[to])))
        return order[::-1]

    def _from(self, starts: set[Place], order: list[Place], stops: set[Place]) -> dict[Place, Way]:
        """The longest path to each block from one of the starts, none beyond a stop."""
        ways = {start: self.weights[start] for start in starts if self.weights[start].is_possible}
        for here in order:
            if here not in ways or here in stops:
                continue
            for to in self.next[here]:
                way = total(ways[here], self.weights[to])
                if way.is_possible:
                    ways[to] = longer(ways.get(to, IMPOSSIBLE), way)
        return ways

    def longest(self) -> list[Way]:
        """The longest path of every step in their order, and that of the whole at the end."""
        order = self._order()
        found: list[Way] = []
        starts = {self.entry}
        while starts:
            ways = self._from(starts, order, self.ends)
            ended = {place for place in ways if place in self.ends}
            step = IMPOSSIBLE
            for place in ended | (self.last & ways.keys()):
                step = longer(step, ways[place])
            found.append(step)
            starts = {to for place in ended for to in self.next[place]}
        whole, ways = IMPOSSIBLE, self._from({self.entry}, order, set())
        for place in self.last & ways.keys():
            whole = longer(whole, ways[place])
        return [*found, whole]
