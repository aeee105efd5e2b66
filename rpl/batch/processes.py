"""Projects in processes of their own: one that hangs, crashes or takes all memory loses its project and nothing else.

Each thread has one process and gives it project after project. A pool of the standard library would end with the
first process that dies, and could not end the one that takes too long.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Generator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import suppress
from pathlib import Path
from typing import IO

from rpl.batch import rows
from rpl.batch.asked import Asked
from rpl.batch.finding import Project
from rpl.batch.rows import Row
from rpl.batch.work import Answer

_PROGRAM = "from rpl.batch.worker import main; main()"
# The process ends itself so much later than it is ended here: nobody may be left to do that.
_GRACE_S = 30.0
_TAIL = 2000


class Worker:
    """A process that takes one project after the other. It is started when it is needed, and anew where it is gone."""

    def __init__(self, limit_s: float) -> None:
        self.limit_s = limit_s
        self._process: subprocess.Popen[bytes] | None = None
        self._errors: IO[bytes] | None = None
        self._late = self._ended = False

    def do(self, project: Project, asked: Asked) -> Answer:
        """What comes of the project; for each row it may take the limit."""
        found: list[Row] = []
        self._late = False
        process = self._started()
        assert process.stdin is not None and process.stdout is not None  # as they were asked for
        try:
            pickle.dump((project, asked, self.limit_s + _GRACE_S), process.stdin)
            process.stdin.flush()
            while True:
                made = self._next(process, process.stdout)
                if isinstance(made, Answer):
                    break
                found.append(made)
        except (OSError, EOFError, pickle.UnpicklingError):
            return Answer((*found, self._loss(process, project)))
        if self._late:  # with the last word
            self.close()
        return made

    def end(self) -> None:
        """Ends the process, whatever it does."""
        self._ended = True
        process = self._process
        if process is not None:
            process.kill()

    def close(self) -> None:
        """Lets go of the process, behind its end."""
        process, self._process = self._process, None
        if process is not None:
            for stream in (process.stdin, process.stdout):
                if stream is not None:
                    with suppress(OSError):
                        stream.close()
            process.kill()
            process.wait()
        if self._errors is not None:
            self._errors.close()
            self._errors = None

    def _started(self) -> subprocess.Popen[bytes]:
        if self._process is not None and self._process.poll() is not None:
            self.close()
        if self._process is None:
            self._errors = tempfile.TemporaryFile()  # noqa: SIM115 (open as long as the process)
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-c", _PROGRAM],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                env={**os.environ, "PYTHONPATH": os.pathsep.join(path or str(Path.cwd()) for path in sys.path)},
                start_new_session=True,  # Ctrl-C is for who started the batch
            )
            if self._ended:
                self._process.kill()
        return self._process

    def _next(self, process: subprocess.Popen[bytes], stream: IO[bytes]) -> Row | Answer:
        watch = threading.Timer(self.limit_s, self._is_late, (process,))
        watch.daemon = True
        watch.start()
        try:
            made = pickle.load(stream)
        finally:
            watch.cancel()
            watch.join()
        assert isinstance(made, Row | Answer)
        return made

    def _is_late(self, process: subprocess.Popen[bytes]) -> None:
        self._late = True
        process.kill()

    def _loss(self, process: subprocess.Popen[bytes], project: Project) -> Row:
        process.kill()
        code = process.wait()
        last = self._last_words()
        late = self._late
        self.close()
        if late:
            return Row(project.name, outcome=rows.TOO_LONG, reason=f"ended after {self.limit_s:g} s")
        if code < 0:
            name = signal.strsignal(-code) or f"signal {-code}"
            return Row(project.name, outcome=rows.LOST, reason=f"its process was ended: {name.lower()}")
        said = f": {last}" if last else ""
        return Row(project.name, outcome=rows.LOST, reason=f"its process ended with {code}{said}")

    def _last_words(self) -> str:
        if self._errors is None:
            return ""
        size = self._errors.seek(0, os.SEEK_END)
        self._errors.seek(max(0, size - _TAIL))
        lines = self._errors.read().decode("utf-8", "replace").split("\n")
        return next((line.strip() for line in reversed(lines) if line.strip()), "")


def answers(
    projects: Sequence[Project], asked: Asked, jobs: int, limit_s: float
) -> Generator[tuple[Project, Answer], None, None]:
    """What comes of each project, in the order in which they are done. Who closes the iterator ends the processes."""
    here, workers = threading.local(), list[Worker]()

    def do(project: Project) -> Answer:
        if not hasattr(here, "worker"):
            here.worker = Worker(limit_s)
            workers.append(here.worker)
        worker: Worker = here.worker
        return worker.do(project, asked)

    pool = ThreadPoolExecutor(max(1, min(jobs, len(projects))))
    waiting: dict[Future[Answer], Project] = {pool.submit(do, project): project for project in projects}
    try:
        for done in as_completed(tuple(waiting)):
            yield waiting.pop(done), done.result()
    finally:
        for future in waiting:
            future.cancel()
        for worker in workers:
            worker.end()
        pool.shutdown()
        for worker in workers:
            worker.close()
