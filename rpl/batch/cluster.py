"""Projects over several machines, by dask.distributed. Each of its workers has processes as a batch on one machine has
them; the folder must be under the same path on all machines."""

from __future__ import annotations

import threading
from collections.abc import Generator, Sequence
from importlib.util import find_spec

from rpl.batch import rows
from rpl.batch.asked import Asked
from rpl.batch.finding import Project
from rpl.batch.processes import Worker
from rpl.batch.rows import Row
from rpl.batch.work import Answer
from rpl.errors import UsageError

_HERE = threading.local()
_CONNECT_S = 30.0


def on_a_machine(project: Project, asked: Asked, limit_s: float) -> Answer:
    """What a machine of the cluster does: the thread keeps its process for the next project."""
    worker: Worker | None = getattr(_HERE, "worker", None)
    if worker is None or worker.limit_s != limit_s:
        worker = _HERE.worker = Worker(limit_s)
    return worker.do(project, asked)


def needs_dask() -> None:
    """Raises UsageError where the package is missing."""
    if find_spec("distributed") is None:
        raise UsageError("--dask needs the package distributed: pip install 'robot-rpl[dask]'")


def answers(
    projects: Sequence[Project], asked: Asked, address: str, limit_s: float
) -> Generator[tuple[Project, Answer], None, None]:
    """What comes of each project, in the order in which they are done. Raises UsageError when no scheduler answers."""
    needs_dask()
    from distributed import Client, as_completed

    try:
        client = Client(address, timeout=_CONNECT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise UsageError(f"no scheduler of dask answers at {address}: {error}") from None
    with client:
        waiting = {client.submit(on_a_machine, one, asked, limit_s, pure=False): one for one in projects}
        try:
            for future in as_completed(list(waiting), loop=client.loop):
                project = waiting.pop(future)
                failed = future.exception() if future.status != "finished" else None
                lost = Row(project.name, outcome=rows.LOST, reason=f"its machine was lost: {type(failed).__name__}")
                yield project, future.result() if future.status == "finished" else Answer((lost,))
                future.release()
        finally:
            client.cancel(list(waiting))
