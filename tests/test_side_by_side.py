"""Work in threads gives what a loop gives, in order, and raises what it raises; inside of a thread it is a loop."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from lagnet import side_by_side as module
from lagnet.side_by_side import side_by_side


def slow_square(x: int) -> int:
    time.sleep(0.01 * (5 - x))  # the first is the last to end
    return x * x


def test_results_come_in_the_order_of_the_items(monkeypatch):
    monkeypatch.setattr(module, "usable_cores", lambda: 4)
    assert side_by_side(slow_square, range(5)) == [0, 1, 4, 9, 16]
    assert side_by_side(slow_square, []) == []


def test_two_items_are_worked_on_at_once(monkeypatch):
    monkeypatch.setattr(module, "usable_cores", lambda: 2)
    both = threading.Barrier(2, timeout=10.0)
    assert sorted(side_by_side(lambda _: both.wait(), [0, 1])) == [0, 1]


def test_work_that_is_in_a_thread_already_stays_there():
    def inner(_: int) -> list[str]:
        return side_by_side(lambda _: threading.current_thread().name, [0, 1])

    with ThreadPoolExecutor(1, thread_name_prefix="worker") as pool:
        assert set(pool.submit(inner, 0).result()) == {"worker_0"}


def test_what_an_item_raises_is_raised(monkeypatch):
    monkeypatch.setattr(module, "usable_cores", lambda: 2)
    with pytest.raises(ZeroDivisionError):
        side_by_side(lambda x: 1 // x, [1, 0])
