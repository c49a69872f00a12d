"""Work beside the capture: in order, in a thread of its own, so that no frame waits for it."""

from __future__ import annotations

import queue
import sys
import threading
from collections.abc import Callable
from types import TracebackType

MOST_WAITING = 10_000
"""Jobs that may wait, two minutes of frames; a replay, which is fast, waits for them here."""

SWITCH_S = 0.5e-3
"""How long the capture waits for its turn while a job computes: several times a frame, once after
each call to the runtime. Python's own 5 ms add up to lost frames."""


class Beside:
    """Does jobs one after another in a thread.

    What a job raises is raised in the thread that gives the next one, or that closes.
    """

    def __init__(self) -> None:
        self._jobs: queue.Queue[Callable[[], None] | None] = queue.Queue(MOST_WAITING)
        self._failed: BaseException | None = None
        self._worker = threading.Thread(target=self._work, daemon=True)
        self._worker.start()

    def __enter__(self) -> Beside:
        self._interval_s = sys.getswitchinterval()
        sys.setswitchinterval(SWITCH_S)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._jobs.put(None)
        self._worker.join()
        sys.setswitchinterval(self._interval_s)
        if error is None:
            self._raise()

    def do(self, job: Callable[[], None]) -> None:
        """Have a job done, after those that were given before."""
        self._raise()
        self._jobs.put(job)

    def _raise(self) -> None:
        if self._failed is not None:
            raise self._failed

    def _work(self) -> None:
        while (job := self._jobs.get()) is not None:
            if self._failed is None:  # after a failure the queue is only emptied
                try:
                    job()
                except BaseException as error:
                    self._failed = error
