"""Workers of a Dask cluster. One that is lost is no loss: the scheduler gives its task to another one."""

from __future__ import annotations

import functools
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from stillspin.drive.own import firmware
from stillspin.errors import CampaignError, InputError
from stillspin.exit_codes import ExitCode
from stillspin.extras import need
from stillspin.revision import revision
from stillspin.runs.reporting import reporting

_PATIENCE = 30.0  # s, for the scheduler and the first worker
_EVERY = 0.5  # s between two words of a worker

_one_at_a_time = threading.Lock()
"""The firmware has static state, as on its chip: a worker with several threads does one task at a time."""


class ClusterError(CampaignError):
    """The cluster cannot be used."""

    exit_code = ExitCode.NO_CONNECTION


@dataclass(frozen=True)
class _Campaign:
    """What every task of a campaign carries along. `ours`: sources and firmware; `name`: unique."""

    ours: str
    name: str = field(default_factory=lambda: f"stillspin-{uuid.uuid4().hex}")


class _Cluster(Executor):
    """The executor of a client, with what a campaign needs around a task."""

    def __init__(self, client: Any) -> None:
        self._client, self._executor = client, client.get_executor(pure=False)
        self._campaign = _Campaign(_ours())
        self._stop = need("distributed").Event(self._campaign.name, client)

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **_: Any) -> Future[Any]:
        future: Future[Any] = self._executor.submit(_carry_out, self._campaign, function, arguments)
        return future

    def ahead(self) -> int:
        """Tasks that keep all workers busy that are there now."""
        return 2 * max(1, len(self._client.nthreads()))

    def listen(self, shares: list[float]) -> None:
        """Take the shares of the tasks."""

        def heard(event: tuple[float, tuple[int, float]]) -> None:
            slot, share = event[1]
            if slot < len(shares):
                shares[slot] = share

        self._client.subscribe_topic(self._campaign.name, heard)

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._executor.shutdown(wait=False)


@contextmanager
def connected(address: str, shares: list[float]) -> Iterator[_Cluster]:
    """The workers of a cluster until the context ends.

    Args:
        address: of its scheduler, such as tcp://host:8786.
        shares: takes what the tasks report.

    Raises:
        InputError: Dask is not installed, or this is no address.
        ClusterError: nobody answers, or there is no worker.
        CampaignError: the workers cannot do it.
    """
    distributed = need("distributed")
    try:
        client = distributed.Client(address, timeout=_PATIENCE, set_as_default=False)
    except OSError as error:
        raise ClusterError(f"--cluster {address}: there is no scheduler that answers") from error
    except ValueError as error:
        raise InputError(f"--cluster {address}: is no address of a scheduler: {error}") from error
    with client:
        try:
            client.wait_for_workers(1, _PATIENCE)
        except TimeoutError as error:
            raise ClusterError(f"--cluster {address}: has no worker") from error
        with _Cluster(client) as cluster:
            cluster.listen(shares)
            try:
                yield cluster
            except distributed.KilledWorker as error:
                raise CampaignError(f"--cluster {address}: task after task has killed its worker: {error}") from error
            except ModuleNotFoundError as error:
                raise CampaignError(f"--cluster {address}: a worker lacks something: {error}") from error


@functools.cache
def _ours() -> str:
    return f"{revision()}, {firmware()}"


def _carry_out(campaign: _Campaign, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    """In a worker."""
    distributed = need("distributed")
    worker = distributed.get_worker()
    stop = distributed.Event(campaign.name)
    last = time.monotonic()

    def told(slot: int, share: float) -> bool:
        nonlocal last
        if time.monotonic() - last < _EVERY:
            return True
        last = time.monotonic()
        worker.log_event(campaign.name, (slot, share))
        return not stop.is_set()

    with _one_at_a_time, reporting(told):
        if _ours() != campaign.ours:
            raise CampaignError(f"worker {worker.address} has other sources: {_ours()}; here: {campaign.ours}")
        return function(*arguments)
