# SPDX-License-Identifier: LGPL-2.1-or-later
"""A study on the workers of a dask cluster: docs/guide/studies.md.

A worker solves tasks, one mechanics model at one point each, and hands back what the study's store
keeps of them. This process alone writes the store. The workers get the study's files by the
network: they need this package, and no common folder.
"""

from __future__ import annotations

import contextlib
import functools
import os
import tempfile
import threading
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from . import program
from ._core import StudyFile, StudyStore
from .errors import Error, InputError, SolverError
from .files import text_of

Task = tuple[int, str]  # point, mechanics model
Files = tuple[tuple[str, bytes], ...]
Fingerprint = tuple[tuple[str, str], ...]

# Largest batch of rods, whose solution takes a millisecond: a worker that dies may lose one.
_LARGEST_BATCH = 64
_BATCHES_PER_WORKER = 8

_ENDED = (
    "the cluster has ended before the study. What was solved is kept: the same call goes on from there"
)

_one_batch = threading.Lock()


def solve(file: str | Path, folder: str | Path, client: Any) -> None:
    """Solves by the workers of a distributed.Client what the study's store does not keep yet.

    A study that optimises is left to the program: each of its designs depends on the last one.
    Raises InputError, FileError, SolverError; what has been solved is kept in any case.
    """
    study = StudyFile(str(file))
    if study.optimises:
        return
    _require_same_program(study)
    with contextlib.closing(StudyStore(study, str(folder))) as store:
        batches = _batches(*store.missing(), _workers(client))
        _distribute(study, store, batches, client)


def _require_same_program(study: StudyFile) -> None:
    here, there = dict(study.fingerprint)["program"], program.call("--version").strip()
    if here != there:
        raise InputError(
            f"this package is {here}, but the program {program.program()} is {there}: it would "
            "refuse the solutions; install both from one build"
        )


def _batches(rods: list[Task], others: list[Task], workers: int) -> list[list[Task]]:
    """Batches of tasks. Models that use all cores by themselves come first, one by one: they take longest."""
    share = -(-len(rods) // (_BATCHES_PER_WORKER * max(workers, 1)))
    size = max(1, min(share, _LARGEST_BATCH))
    return [[task] for task in others] + [rods[i : i + size] for i in range(0, len(rods), size)]


def _distribute(study: StudyFile, store: StudyStore, batches: list[list[Task]], client: Any) -> None:
    from distributed import CancelledError, KilledWorker

    inputs = _packed(study.files), tuple(study.fingerprint)
    waiting = batches[::-1]
    running: dict[Any, list[Task]] = {}
    suspects: list[list[Task]] = []
    deadly: list[list[Task]] = []
    alone = False
    try:
        while waiting or running or suspects:
            if not waiting and not running:
                # dask blames a worker's death on all that it had: only one that ran alone is guilty.
                waiting, suspects, alone = suspects, [], True
            # A worker has what it is at and the next one.
            while waiting and len(running) < (1 if alone else 2 * max(_workers(client), 1)):
                batch = waiting.pop()
                running[client.submit(_solve, *inputs, batch, key=_key(study, batch))] = batch
            done = [future for future in running if future.done()]
            if not done:
                time.sleep(0.02)
            for future in done:
                batch = running.pop(future)
                try:
                    solved = _checked(future.result(), batch)
                except KilledWorker:
                    (deadly if alone else suspects).append(batch)
                    continue
                except (CancelledError, Error):
                    raise
                except Exception as error:  # whatever a worker may raise, MemoryError among it
                    point, mechanics = batch[0]
                    raise SolverError(
                        f"a worker failed with {mechanics} at point {point} or one of the {len(batch)} "
                        f"of its batch: {text_of(error)}"
                    ) from error
                for (point, mechanics), solution in solved.items():
                    store.keep(point, mechanics, solution)
    except CancelledError as error:
        raise SolverError(_ENDED) from error
    finally:
        if client.status == "running":
            client.cancel(list(running))
    if deadly:
        point, mechanics = deadly[0][0]
        raise SolverError(
            f"each worker that solved {mechanics} at point {point} has died, with nothing else to do; "
            f"too little memory may be why: {len(deadly)} of {len(batches)} batches are missing. All others are kept; the "
            "same call tries these again"
        )


def _checked(reply: Any, batch: list[Task]) -> dict[Task, str]:
    """The solutions of a batch by their tasks, which the reply states. Raises SolverError if it is
    another batch's, or no reply at all."""
    point, mechanics = batch[0]
    try:
        solved = {(int(task[0]), str(task[1])): solution for task, solution in reply}
        is_whole = len(reply) == len(batch) and solved.keys() == {(task[0], task[1]) for task in batch}
    except (TypeError, ValueError, IndexError):
        solved, is_whole = {}, False
    if not is_whole or not all(isinstance(solution, str) for solution in solved.values()):
        raise SolverError(
            f"a worker's reply to {mechanics} at point {point} and the {len(batch) - 1} others of its batch "
            "is not the solution of these: all machines need the same build of ciliaval"
        )
    return solved


def _workers(client: Any) -> int:
    if client.status != "running":
        raise SolverError(_ENDED)
    try:
        return len(client.nthreads())
    except OSError as error:  # those of dask's connections
        raise SolverError(_ENDED) from error


def _key(study: StudyFile, batch: list[Task]) -> str:
    """Name of the batch on dask's pages; random in part, for a second call is a second computation."""
    point, mechanics = batch[0]
    return f"{study.name}.{mechanics}.{point}-{os.urandom(8).hex()}"


def _packed(files: Iterable[str]) -> Files:
    """The files by their names below the folder that all of them lie in; the first one is the study."""
    paths = [os.path.abspath(file) for file in files]
    root = os.path.commonpath([os.path.dirname(path) for path in paths])
    return tuple((os.path.relpath(path, root), Path(path).read_bytes()) for path in paths)


# In a worker.


def _solve(files: Files, expected: Fingerprint, tasks: list[Task]) -> list[tuple[Task, str]]:
    """Each task with its solution. One batch at a time, whatever the number of the worker's threads: it takes all cores."""
    # Below srun Open MPI would take each worker for a rank of one program, and end it.
    os.environ.pop("SLURM_NODELIST", None)
    with _one_batch:
        study, _ = _opened(files, expected)
        return list(zip(tasks, study.solve(tasks)))


@functools.lru_cache(maxsize=1)
def _opened(files: Files, expected: Fingerprint) -> tuple[StudyFile, tempfile.TemporaryDirectory[str]]:
    """The study read from copies of its files, which stay as long as it does."""
    from distributed import get_worker

    folder = tempfile.TemporaryDirectory(dir=get_worker().local_directory)
    for name, content in files:
        path = Path(folder.name, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    study = StudyFile(str(Path(folder.name, files[0][0])))
    own = study.fingerprint
    for name, value in set(expected) - set(own):
        raise InputError(
            f"a worker has another study: {name} is {dict(own).get(name)} there, here {value}. "
            "All machines need the same build of ciliaval and the same files"
        )
    return study, folder
