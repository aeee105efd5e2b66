"""Programs beside each other, as the target begins, ends and asks them."""

from __future__ import annotations

from rpl.passes.legalise.stages import Stage
from rpl.passes.legalise.tasks.calledtasks import called_tasks
from rpl.passes.legalise.tasks.handles import known_handles
from rpl.passes.legalise.tasks.secondstarts import second_starts

STAGE = Stage(
    "tasks",
    (
        known_handles,
        second_starts,
        called_tasks,
    ),
)
