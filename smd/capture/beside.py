"""A worker process beside the capture: it does jobs in order, and no frame waits for it."""

from __future__ import annotations

import gc
import multiprocessing
import queue
import signal
import threading
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from types import TracebackType

from smd.errors import CaptureError

MOST_WAITING = 10_000
"""Capacity of the queue of jobs, two minutes of frames; a replay, which is fast, waits for it."""


class Beside:
    """Does jobs one after another in a process.

    A thread of this process would share Python's lock with the recording thread. That one would
    wait for the lock while the other computes, or itself waits for a core.

    Parameters
    ----------
    work
        Called in the process; returns the object whose methods do the jobs. It must be defined in a
        module, with arguments that can be copied (it and the jobs are pickled, by this program for
        itself).

    An exception of a job is raised where the next job is given, or at the end; jobs that follow it
    are skipped. If this process dies, the other finishes its jobs, and ends.
    """

    def __init__(self, work: Callable[[], object]) -> None:
        context = multiprocessing.get_context("spawn")  # on every system, and safe beside threads
        theirs, self._jobs = context.Pipe(duplex=False)
        self._answers, answers = context.Pipe(duplex=False)
        self._process = context.Process(target=_serve, args=(work, theirs, answers), daemon=True)
        # Ctrl-C is for this process: the other ends when it has finished its jobs.
        handler = signal.signal(signal.SIGINT, signal.SIG_IGN)
        try:
            self._process.start()
        finally:
            signal.signal(signal.SIGINT, handler)
        theirs.close()
        answers.close()
        self._waiting: queue.Queue[tuple[str, tuple[object, ...]] | None]
        self._waiting = queue.Queue(MOST_WAITING)
        self._feeder = threading.Thread(target=self._feed, daemon=True)
        self._feeder.start()

    def __enter__(self) -> Beside:
        """Wait until the process has begun to work."""
        self._answers.poll(None)
        try:
            self._raise()
        except BaseException:
            self._end()
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._end()
        if error is None:
            self._raise()

    def do(self, job: str, *arguments: object) -> None:
        """Queue a call of one of the work's methods."""
        self._raise()
        self._waiting.put((job, arguments))

    def _end(self) -> None:
        """Wait until all jobs are done."""
        self._waiting.put(None)
        self._feeder.join()
        self._process.join()

    def _feed(self) -> None:
        """Pass on queued jobs: the pipe is short, and the process busy now and then."""
        broken = False
        while (job := self._waiting.get()) is not None:
            if not broken:  # else the queue is only emptied
                try:
                    self._jobs.send(job)
                except OSError:
                    broken = True
        with suppress(OSError):
            self._jobs.close()

    def _raise(self) -> None:
        """Raise the error of the other process, or one that says that it is gone."""
        while self._answers.poll():
            try:
                failed = self._answers.recv()
            except EOFError:
                self._process.join()
                if self._process.exitcode == 0 and self._waiting.empty():
                    return
                raise CaptureError(
                    "what understands stories has stopped (exit code "
                    f"{self._process.exitcode}); what was recorded is kept"
                ) from None
            if failed is not None:
                raise failed


def _serve(work: Callable[[], object], jobs: Connection, answers: Connection) -> None:
    """Do the jobs; report that work has begun, and the first exception."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        worker = work()
        gc.collect()
        gc.freeze()  # a pass over all loaded objects would delay a job by some 20 ms
        answers.send(None)
        while True:
            try:
                job, arguments = jobs.recv()
            except EOFError:
                return
            getattr(worker, job)(*arguments)
    except BaseException as error:
        with suppress(OSError):
            answers.send(error)
    with suppress(EOFError, OSError):
        while True:  # the other side must not wait for a full pipe
            jobs.recv()
