"""Many independent pieces of work through Dask: processes of this machine, or a cluster that exists.

What is lost with a worker is done again by another one; what fails comes back as its error beside the results of the
others. Scheduling, retries and the bound on memory are Dask's.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from lagnet.errors import LagnetError, MissingExtraError

CONNECTING = 30  # [s] after which a scheduler that does not answer counts as absent


@dataclass(frozen=True)
class EngineSettings:
    """Where the work is done.

    Args:
        scheduler: address of a Dask scheduler, such as tcp://10.0.0.1:8786; None: processes of this machine.
        workers: processes of this machine; None: one a core.
        memory: bound of each process of this machine [bytes]; a process that passes it is started anew.
        retries: times that a piece of work which failed, say for want of the network, is tried again.
    """

    scheduler: str | None = None
    workers: int | None = None
    memory: int = 1_500_000_000
    retries: int = 2


@dataclass(frozen=True)
class Outcome:
    """What became of one piece of work: its result, or one line on why there is none."""

    index: int
    result: Any = None
    error: str | None = None


class Engine:
    """A connection to workers; see `open_engine`."""

    def __init__(self, client: Any, retries: int):
        self.client, self.retries = client, retries

    def run(self, work: Callable[[Any], Any], items: Sequence[Any]) -> Iterator[Outcome]:
        """The outcome of work(item) for every item, as they are finished.

        Args:
            work: a function that workers can import by its name.
            items: what it is called with.
        """
        from distributed import as_completed

        futures = self.client.map(work, items, retries=self.retries, pure=False, batch_size=500)
        index_of = {future.key: i for i, future in enumerate(futures)}
        for future in as_completed(futures):
            index = index_of[future.key]
            if future.status == "finished":
                yield Outcome(index, future.result())
            else:
                yield Outcome(index, error=_told(future))
            future.release()


def _told(future: Any) -> str:
    from distributed.scheduler import KilledWorker

    if future.status == "cancelled":
        return "was cancelled by the cluster"
    error = future.exception()
    if isinstance(error, KilledWorker):
        return "its worker was lost several times; most often it needs more memory than --memory allows"
    words = " ".join(str(error).split())
    return words if isinstance(error, LagnetError) else f"{type(error).__name__}: {words}"


@contextmanager
def open_engine(settings: EngineSettings) -> Iterator[Engine]:
    """Workers, for as long as the context lasts.

    Raises:
        MissingExtraError: Dask is not installed.
        LagnetError: no scheduler answers at the address.
    """
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        raise MissingExtraError("tracking needs Dask", next_step="install lagnet[tracking]") from None
    if settings.scheduler is not None:
        try:
            client = Client(settings.scheduler, timeout=CONNECTING)
        except (OSError, ValueError) as error:
            raise LagnetError(
                f"no Dask scheduler answers ({error})",
                where=settings.scheduler,
                next_step="start one with `dask scheduler`, and workers with `dask worker ADDRESS`",
            ) from None
        with client:
            yield Engine(client, settings.retries)
        return
    from dask.system import CPU_COUNT

    with (
        LocalCluster(
            n_workers=settings.workers or CPU_COUNT,
            threads_per_worker=1,
            processes=True,
            memory_limit=settings.memory,
            dashboard_address="127.0.0.1:0",
            silence_logs=logging.CRITICAL,
        ) as cluster,
        Client(cluster) as client,
    ):
        yield Engine(client, settings.retries)
