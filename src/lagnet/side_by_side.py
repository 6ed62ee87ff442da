"""work(item) for several items on all cores of this process, in threads: for compiled code that lets go of the GIL."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


def side_by_side(work: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
    """The results in the order of the items, the same as of a loop.

    Work that is itself in a thread, as in a worker of a fleet, where every core has its own, is done one by one.

    Raises:
        Exception: the first that an item raised.
    """
    threads = min(usable_cores(), len(items))
    if threads < 2 or threading.current_thread() is not threading.main_thread():
        return [work(item) for item in items]
    with ThreadPoolExecutor(threads, thread_name_prefix="lagnet") as pool:
        return list(pool.map(work, items))


def usable_cores() -> int:
    """Cores that this process may run on."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
