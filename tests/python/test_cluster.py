# SPDX-License-Identifier: LGPL-2.1-or-later
"""Studies on the workers of a dask cluster. Oracle: the files of the same study, run alone."""

import collections
import contextlib
import importlib.util
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock

# Files are the same, byte for byte, where BLAS has as many threads. It is loaded with NumPy.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np

import ciliaval as cv
from ciliaval import program
from test_results import quick

SOURCE = Path(__file__).resolve().parents[2]

HAS_DASK = importlib.util.find_spec("distributed") is not None
if HAS_DASK:
    import dask
    from distributed import Client, LocalCluster, WorkerPlugin

    from ciliaval import cluster
    from ciliaval._core import StudyFile, StudyStore

    class Diary(WorkerPlugin):
        """Writes when a worker begins and ends a task: a line in a file named by its process."""

        def __init__(self, folder):
            self.folder = folder

        def transition(self, key, start, finish, **_):
            if finish in ("executing", "memory"):
                with open(Path(self.folder, str(os.getpid())), "a") as file:
                    file.write(f"{finish} {key}\n")


# A short cilium, which the solid solves within a second.
SHORT = quick("fig3b").replace('length = "17 mm"', 'length = "3 mm"').replace('height = "16 mm"', 'height = "5 mm"')

# Points that converge, slip off and fail, by rods and by the solid.
STUDY = """
[study]
name = "mine"
case = "../case.toml"
pairs = ["elastica/volume", "beam/volume", "solid/mesh"]
outputs = ["dB_norm"]
combine = "zip"
[fixed]
load.force = "2 mN"
models.solid.refinement = 0
[[parameter]]
path = "cilium.segment.base.young_modulus"
values = ["0.01 MPa", "0.1 MPa", "0.2 MPa", "0.3 MPa", "0.4 MPa", "0.5 MPa"]
[[parameter]]
path = "models.beam.max_iterations"
values = [30, 31, 1, 32, 33, 34]
"""

RODS = """
[study]
name = "rods"
case = "../case.toml"
pairs = ["elastica/line"]
outputs = ["dB_norm", "sensitivity"]
[fixed]
load.force = "1 mN"
[[parameter]]
path = "cilium.segment.base.young_modulus"
from = "0.1 MPa"
to = "3 MPa"
count = 300
"""

OPTIMUM = """
[study]
name = "best"
case = "../case.toml"
pairs = ["elastica/line"]
[fixed]
load.force = "1 mN"
[optimise]
maximise = "dB_norm"
global_evaluations = 0
starts = 1
[[parameter]]
path = "cilium.diameter"
from = "2.8 mm"
to = "3.2 mm"
"""


# Ends the worker's process at one point, in place of solving it.
POISON = """
import os
from ciliaval._core import StudyFile
def solve(study, tasks, solve=StudyFile.solve):
    return os._exit(1) if (3, "solid") in tasks else solve(study, tasks)
StudyFile.solve = solve
"""

# Starts two processes on this machine with the environment of a step of Slurm.
SRUN = """#!/bin/sh
while [ "${1#--}" != "$1" ]; do shift; done
export SLURM_JOB_ID=1 SLURM_STEP_ID=0 SLURM_NODELIST=localhost SLURM_NTASKS=2 SLURM_STEP_NUM_TASKS=2
for SLURM_PROCID in 0 1; do export SLURM_PROCID; "$@" & done
wait
"""


def files(folder):
    """The results; the store, whose entries are in the order in which they came, is no result."""
    return {f.name: f.read_bytes() for f in Path(folder).iterdir() if "sqlite" not in f.name}


@unittest.skipUnless(HAS_DASK, "dask.distributed is not installed (python3-distributed)")
class ClusterTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        (cls.folder / "case.toml").write_text(SHORT)
        (cls.folder / "studies").mkdir()

    def study(self, text):
        name = re.search('name = "(.*)"', text)[1]
        file = self.folder / "studies" / f"{name}.study.toml"
        file.write_text(text)
        return file

    def alone(self, text):
        """The files of a run alone."""
        name = re.search('name = "(.*)"', text)[1]
        if not (self.folder / "alone" / name).exists():
            cv.study(self.study(text), self.folder / "alone")
        return files(self.folder / "alone" / name)

    @contextlib.contextmanager
    def workers(self, **options):
        """A client of two worker processes, and the folder of their diaries."""
        diaries = Path(tempfile.mkdtemp(dir=self.folder))
        with LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, **options
        ) as local, Client(local) as client:
            client.register_worker_plugin(Diary(str(diaries)))
            yield client, diaries

    def wait(self, condition):
        end = time.monotonic() + 120
        while not (found := condition()):
            self.assertLess(time.monotonic(), end, "nothing happened")
            time.sleep(0.005)
        return found

    def busy(self, diaries):
        """A process that is in the middle of a solid."""

        def look():
            for file in diaries.iterdir():
                lines = file.read_text().splitlines()
                if lines and lines[-1].startswith("executing mine.solid"):
                    return int(file.name)
            return None

        process = self.wait(look)
        time.sleep(0.1)  # the other processes hear of what it has finished before
        return process

    def counts(self, diaries):
        """How often each batch was begun and ended, by all workers together."""
        begun, ended = collections.Counter(), collections.Counter()
        for file in diaries.iterdir():
            for line in file.read_text().splitlines():
                what, key = line.split(" ", 1)
                (begun if what == "executing" else ended)[key] += 1
        return begun, ended


class Study(ClusterTest):
    def test_survives_a_worker_and_gives_the_files_of_a_run_alone(self):
        expected = self.alone(STUDY)
        for status in ("converged", "slipped_off", "failed"):
            self.assertIn(f'"{status}"', expected["study.json"].decode())
        with self.workers() as (client, diaries):
            command = start(self, client, self.study(STUDY), self.folder / "killed")
            os.kill(self.busy(diaries), signal.SIGKILL)
            self.assertEqual(command.wait(timeout=300), 0)
            begun, ended = self.counts(diaries)
        self.assertEqual(files(self.folder / "killed" / "mine"), expected)
        # Nothing is lost, nothing done twice but what the dead worker was at.
        self.assertEqual(len(ended), 18)
        self.assertEqual(set(ended.values()), {1})
        self.assertEqual(sorted(begun.values()), [1] * 17 + [2])
        self.assertIn("solid", begun.most_common(1)[0][0])

    def test_agrees_with_a_run_on_more_threads_of_blas(self):
        """To 1e-12, as docs/guide/studies.md says; measured 5e-15."""
        with mock.patch.dict(os.environ, OPENBLAS_NUM_THREADS="2"):
            other = cv.study(self.study(STUDY), self.folder / "threads")["points"]
        expected = json.loads(self.alone(STUDY)["study.json"])["points"]
        compared = 0
        for point, reference in zip(other, expected, strict=True):
            for pair, of in reference["pairs"].items():
                there = point["pairs"][pair]
                self.assertEqual(there["status"], of["status"])
                if of["status"] == "converged":
                    for name in ("dB_norm", "dB_uncertainty"):
                        np.testing.assert_allclose(there[name], of[name], 0, 1e-12 * of["dB_norm"])
                        compared += 1
        self.assertGreater(compared, 20)

    def test_goes_on_after_its_client_was_killed(self):
        file, folder = self.study(STUDY), self.folder / "again"
        with self.workers() as (client, diaries):
            command = start(self, client, file, folder)
            self.wait(lambda: len(self.counts(diaries)[1]) >= 2)
            self.busy(diaries)
            command.kill()
            command.wait()
            before, _ = self.counts(diaries)
            with contextlib.closing(StudyStore(StudyFile(str(file)), str(folder))) as store:
                missing = sum(map(len, store.missing()))
            self.assertTrue(0 < missing < 18, missing)
            document = cv.study(file, folder, client)
            begun, _ = self.counts(diaries)
        # A batch that a worker was solving when the client was killed may go on, and is then taken as it is.
        again = len(begun - before)
        self.assertTrue(missing - 2 <= again <= missing, (again, missing))
        self.assertEqual(len(document["points"]), 6)
        self.assertEqual(files(folder / "mine"), self.alone(STUDY))

    def test_needs_no_common_folder(self):
        """The files are gone before the workers ask for them."""
        away = self.folder / "away"
        (away / "cases").mkdir(parents=True)
        case = away / "cases" / "case.toml"
        case.write_text(SHORT)
        program.call("mesh", case, "-o", away / "my.msh")
        case.write_text(SHORT + '[models.solid]\nmesh = "../my.msh"\n')
        file = away / "one.study.toml"
        file.write_text(STUDY.replace("../case", "cases/case").replace("models.solid.refinement", "#"))
        study = StudyFile(str(file))
        self.assertEqual(len(study.files), 3)
        packed, expected = cluster._packed(study.files), tuple(study.fingerprint)
        solution = study.solve([(1, "solid")])
        with self.workers() as (client, _):
            shutil.rmtree(away)
            there = client.submit(cluster._solve, packed, expected, [(1, "solid")])
            self.assertEqual(there.result(), [((1, "solid"), solution[0])])
            other = (*expected[:-1], ("program", "ciliaval 0.0.1"))
            changed = (*packed[:2], (packed[2][0], packed[2][1] + b" "))
            with self.assertRaisesRegex(cv.InputError, "mesh is .*checksum"):
                client.submit(cluster._solve, changed, expected, [(1, "solid")]).result()
            with self.assertRaisesRegex(cv.InputError, "program is ciliaval .* here ciliaval 0.0.1"):
                client.submit(cluster._solve, packed, other, [(1, "solid")]).result()

    def test_of_rods_goes_in_batches(self):
        with self.workers() as (client, diaries):
            cv.study(self.study(RODS), self.folder / "quick", client)
            begun, _ = self.counts(diaries)
        self.assertEqual(files(self.folder / "quick" / "rods"), self.alone(RODS))
        self.assertEqual(len(begun), 16)

    def test_keeps_each_solution_under_its_own_task(self):
        """A worker hands a batch back in another order."""
        file, folder = self.study(RODS), self.folder / "order"
        study = StudyFile(str(file))

        def submit(solve, files, expected, batch, key):
            solved = list(zip(batch, study.solve(batch)))[::-1]
            return mock.Mock(done=lambda: True, result=lambda: solved)

        client = mock.Mock(status="running", submit=submit, nthreads=lambda: {"worker": 1})
        with contextlib.closing(StudyStore(study, str(folder))) as store:
            cluster._distribute(study, store, cluster._batches(*store.missing(), 1), client)
            self.assertEqual(store.missing(), ([], []))
        cv.study(file, folder)
        self.assertEqual(files(folder / "rods"), self.alone(RODS))

    def test_leaves_an_optimum_to_the_program(self):
        with self.workers() as (client, diaries):
            cv.study(self.study(OPTIMUM), self.folder / "optimum", client)
            self.assertEqual(self.counts(diaries), ({}, {}))
        self.assertEqual(files(self.folder / "optimum" / "best"), self.alone(OPTIMUM))


class Faults(ClusterTest):
    def test_a_point_that_kills_its_workers_is_named_and_the_others_are_kept(self):
        file, folder = self.study(STUDY), self.folder / "deadly"
        poison = self.folder / "poison.py"
        poison.write_text(POISON)
        # At the first death dask gives up all that the worker had, the batch behind the deadly one too.
        config = dask.config.set({"distributed.scheduler.allowed-failures": 0})
        with config, self.workers(preload=[str(poison)]) as (client, _):
            with self.assertRaisesRegex(cv.SolverError, "solved solid at point 3 has died.* 1 of 18"):
                cv.study(file, folder, client)
        with contextlib.closing(StudyStore(StudyFile(str(file)), str(folder))) as store:
            self.assertEqual(store.missing(), ([], [(3, "solid")]))
        cv.study(file, folder)
        self.assertEqual(files(folder / "mine"), self.alone(STUDY))

    def test_a_scheduler_that_ends_is_an_error(self):
        file, folder = self.study(STUDY), self.folder / "ended"
        with self.workers() as (client, diaries):
            command = start(self, client, file, folder, stderr=subprocess.PIPE, text=True)
            self.busy(diaries)
        _, errors = command.communicate(timeout=120)
        self.assertEqual(command.returncode, 1)
        self.assertIn("SolverError: the cluster has ended", errors)

    def test_a_folder_that_cannot_be_used_is_refused(self):
        file = self.study(RODS)
        foreign = self.folder / "foreign" / "rods"
        foreign.mkdir(parents=True)
        (foreign / "thesis.tex").write_text("")
        with self.workers() as (client, _):
            with self.assertRaisesRegex(cv.FileError, "not the folder of a study"):
                cv.study(file, self.folder / "foreign", client)
            folder = self.folder / "taken"
            with contextlib.closing(StudyStore(StudyFile(str(file)), str(folder))):
                with self.assertRaisesRegex(cv.FileError, "another run"):
                    cv.study(file, folder, client)
            with self.assertRaisesRegex(cv.InputError, "no case file"):
                cv.study(self.study(RODS.replace("../case", "no-case")), folder, client)

    def test_a_program_of_another_build_is_refused_before_anything_runs(self):
        other = self.folder / "ciliaval"
        other.write_text("#!/bin/sh\necho ciliaval 0.0.1\n")
        other.chmod(0o755)
        with mock.patch.dict(os.environ, CILIAVAL_PROGRAM=str(other)):
            with self.assertRaisesRegex(cv.InputError, "the program .* is ciliaval 0.0.1"):
                cv.study(self.study(RODS), self.folder / "build", client=object())
        self.assertFalse((self.folder / "build").exists())


class Documentation(ClusterTest):
    def test_has_a_slurm_script_that_runs(self):
        """With a stand-in for srun."""
        text = (SOURCE / "docs/guide/studies.md").read_text()
        script = re.search("```bash\n(#!/bin/bash\n#SBATCH.*?)```", text, re.S)[1]
        self.assertIn("srun", script)
        with socket.socket() as free:
            free.bind(("", 0))
            script = script.replace("8786", str(free.getsockname()[1]))
        folder = self.folder / "slurm"
        folder.mkdir()
        shutil.copy(self.study(STUDY), folder)
        srun = folder / "srun"
        srun.write_text(SRUN)
        srun.chmod(0o755)
        environment = {**os.environ, "PATH": f"{folder}:/usr/bin:/bin"}
        with (folder / "log").open("w+") as log:
            job = subprocess.Popen(
                ["bash", "-c", script],
                cwd=folder,
                env=environment,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
            self.addCleanup(end_group, job.pid)
            code = job.wait(timeout=240)
            log.seek(0)
            self.assertEqual(code, 0, log.read())
        self.assertEqual(files(folder / "results" / "mine"), self.alone(STUDY))


def start(test, client, file, folder, **more):
    """cv.study() in a process of its own."""
    program_text = (
        "import sys, ciliaval as cv; from distributed import Client\n"
        "cv.study(sys.argv[1], sys.argv[2], Client(sys.argv[3]))"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", program_text, file, folder, client.scheduler.address], **more
    )
    test.addCleanup(lambda: (process.kill(), process.wait()))
    return process


def end_group(process):
    """Ends what is left of a job, as Slurm does."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process, signal.SIGKILL)


@unittest.skipUnless(HAS_DASK, "dask.distributed is not installed")
class Replies(unittest.TestCase):
    """A worker of another build, or one that is broken, must not put numbers at wrong points."""

    batch = [(0, "beam"), (1, "beam")]

    def test_of_the_batch_are_taken_in_any_order(self):
        whole = [(task, f"solution {task[0]}") for task in self.batch]
        self.assertEqual(cluster._checked(whole[::-1], self.batch), dict(whole))

    def test_of_anything_else_are_refused(self):
        one, two = (((i, "beam"), "solution") for i in range(2))
        other = ((2, "beam"), "solution")
        for reply in (None, [], [one], [one, two, two], [one, other], [one, one], [one, ((1, "solid"), "s")],
                      [one, (two[0], None)], [one, 5], "ab", 5):  # fmt: skip
            with self.assertRaisesRegex(cv.SolverError, "beam at point 0"):
                cluster._checked(reply, self.batch)

    def test_what_a_worker_raises_is_said_with_the_point(self):
        for raised in (MemoryError("out of memory"), ZeroDivisionError(), OSError(28, "no space")):
            future = mock.Mock(**{"done.return_value": True, "result.side_effect": raised})
            client = mock.Mock(status="running", **{"submit.return_value": future, "nthreads.return_value": {"w": 1}})
            study = mock.Mock(files=[__file__], fingerprint=())
            study.name = "mine"
            store = mock.Mock()
            with self.assertRaisesRegex(cv.SolverError, "beam at point 0"):
                cluster._distribute(study, store, [self.batch], client)
            store.keep.assert_not_called()


if __name__ == "__main__":
    unittest.main()
