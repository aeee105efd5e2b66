"""Programs beside each other, as the target begins, ends and asks them. They come first of what is rewritten, because
a routine that becomes a task is looked at as a program of its own by all others.
"""

from __future__ import annotations

from rpl.passes.legalise.stages import Clause, Stage
from rpl.passes.legalise.tasks.calledtasks import called_tasks
from rpl.passes.legalise.tasks.secondstarts import second_starts
from rpl.passes.legalise.tasks.startedtasks import started_tasks
from rpl.passes.legalise.tasks.taskdata import shared_task_data
from rpl.passes.legalise.tasks.tasknames import task_names
from rpl.passes.legalise.tasks.taskstates import task_states

STAGE = Stage(
    "tasks",
    (
        shared_task_data,
        task_names,
        started_tasks,
        task_states,
        second_starts,
        called_tasks,
    ),
    Clause(
        functions="task_runs",
        further=frozenset(("data of several tasks",)),
    ),
)
