"""Processes that carry out a campaign: this one, several of this computer, or those of a Dask cluster.

All of them are a `concurrent.futures.Executor`. What a task needs it gets as arguments, what it found it returns, and
files are written where the campaign was started: a worker needs no disk in common with it.
"""

from __future__ import annotations

import multiprocessing as mp
import signal
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any

from stillspin.errors import CampaignError
from stillspin.runs import cluster
from stillspin.runs.held_interrupt import HeldInterrupt
from stillspin.runs.reporting import listen, reporting

_POLL = 0.1  # s between two looks at the progress of the workers

Shares = Callable[[Sequence[float]], None]


@dataclass(frozen=True)
class Where:
    """Who works.

    Attributes:
        jobs: processes of this computer; 1 is this process.
        cluster: address of a Dask scheduler, which has the workers then; empty for none.
    """

    jobs: int = 1
    cluster: str = ""


@dataclass(frozen=True)
class Task:
    """A call of a function of a module.

    Attributes:
        tag: for whoever waits for it.
        near: on this computer, whose files it reads.
    """

    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    tag: Any = None
    near: bool = False


class Workers:
    """What a campaign has its work done by."""

    def __init__(
        self,
        near: Executor,
        far: Executor,
        ahead: Callable[[], int],
        tell: Callable[[], None],
        interrupt: HeldInterrupt,
    ) -> None:
        """Of executors.

        Args:
            near: of this computer.
            far: of whichever computers, may be the same.
            ahead: how many tasks may be with `far` at a time.
            tell: is called several times a second while something is under way.
            interrupt: is heard as often.
        """
        self._near, self._far, self._ahead, self._tell = near, far, ahead, tell
        self._interrupt = interrupt

    def finished(self, waiting: deque[Task]) -> Iterator[tuple[Task, Any]]:
        """Every task as it is done, with its result; more may come into `waiting` meanwhile, at either end.

        No more is under way than keeps the workers busy, so what comes to the front is next.

        Raises:
            CampaignError: a worker process has died, or a cluster has given up.
        """
        pending: dict[Future[Any], Task] = {}
        try:
            while waiting or pending:
                far = sum(not task.near for task in pending.values())
                while waiting and (waiting[0].near or far < self._ahead()):
                    task = waiting.popleft()
                    far += not task.near
                    executor = self._near if task.near else self._far
                    future = executor.submit(task.function, *task.arguments)
                    pending[future] = task
                    if future.done():
                        break
                done, _ = wait(pending, timeout=_POLL, return_when=FIRST_COMPLETED)
                self._tell()
                self._interrupt.hear()
                for future in done:
                    yield pending.pop(future), future.result()
        except BrokenProcessPool as error:
            raise CampaignError("a worker process died (out of memory?); try fewer with --jobs") from error
        except CancelledError as error:
            raise CampaignError("the cluster has dropped a task: its scheduler is gone") from error


@contextmanager
def workers(where: Where, slots: int = 0, watch: Shares = lambda _: None) -> Iterator[Workers]:
    """Workers until the context ends; on an error or an interrupt they stop at their next report.

    Args:
        where: who works.
        slots: how many shares the tasks report.
        watch: is told of them.

    Raises:
        InputError: no such cluster, or what speaks to one is not installed.
    """
    with ExitStack() as held:
        shares = [0.0] * slots
        here: Executor = _Here()
        ahead, tell, interrupt = 1, lambda: watch(shares), HeldInterrupt()
        if where.cluster:
            far = held.enter_context(cluster.connected(where.cluster, shares))
        if where.cluster or where.jobs > 1:
            held.enter_context(interrupt)
        if where.jobs > 1:
            pool = held.enter_context(_Processes(where.jobs, slots))
            here, ahead, tell = pool, where.jobs, lambda: watch(list(pool.shares))
        if where.cluster:
            yield Workers(here, far, far.ahead, lambda: watch(shares), interrupt)
            return

        def told(slot: int, share: float) -> bool:
            if slots:
                shares[slot] = share
            watch(shares)
            return True

        held.enter_context(reporting(told))
        yield Workers(here, here, lambda: ahead, tell, interrupt)


class _Here(Executor):
    """This process, which does a task as soon as it is given."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments, **named))
        except Exception as error:
            future.set_exception(error)
        return future


class _Processes(ProcessPoolExecutor):
    """Processes of this computer. They do not hear Ctrl-C: the one that has started them tells them to end."""

    def __init__(self, jobs: int, slots: int) -> None:
        # A fresh interpreter per worker: nothing of this process's threads or native state is copied into it.
        context = mp.get_context("spawn")
        self.shares = context.Array("d", max(slots, 1), lock=False)
        self._stop = context.Value("b", 0, lock=False)
        super().__init__(jobs, context, _start, (self.shares, self._stop))

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        # A process may be started by this, and is deaf from its first moment on.
        mask = getattr(signal, "pthread_sigmask", None)
        before = mask(signal.SIG_BLOCK, {signal.SIGINT}) if mask else ()
        try:
            return super().submit(function, *arguments, **named)
        finally:
            if mask:
                mask(signal.SIG_SETMASK, before)

    def __exit__(self, *_: object) -> None:
        self._stop.value = 1
        self.shutdown(cancel_futures=True)


def _start(shares: Any, stop: Any) -> None:
    """In a worker; shared memory reaches it only through its start."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def told(slot: int, share: float) -> bool:
        shares[slot] = share
        return not stop.value

    listen(told)
