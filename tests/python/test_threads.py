# SPDX-License-Identifier: LGPL-2.1-or-later
"""Threads, forked processes, Ctrl-C and the end of Python while models are at work.

Each script runs in a process of its own, which may be no loss.
"""

import os
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest
from pathlib import Path

HEAD = """
import multiprocessing, sys, tempfile, threading, time
from pathlib import Path
from concurrent.futures import ThreadPoolExecutor
import numpy as np
import ciliaval as cv
from test_core import contact, paper_cilium
from test_results import quick

cilium = paper_cilium()

def solid(force, **more):
    return cv.bend(cilium, contact(force), "solid", refinement=0, **more).tip[0]

def begin_solid():
    '''A thread that is in the middle of a solid until `go_on` is set.'''
    inside, go_on = threading.Event(), threading.Event()
    thread = threading.Thread(target=lambda: solid(1e-3, progress=lambda _: (inside.set(), go_on.wait())))
    thread.start()
    inside.wait()
    return thread, go_on

def long_case():
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "case.toml")
        file.write_text(quick("fig3b").replace('"beam"', '"beam", "solid"'))
        return cv.Case(file)

def cuboid():
    return cv.Magnet.cuboid([0, 0, 9], [1e-3, 1e-3, 1e-3], 1e6)

loads = [contact(1e-6 * (i + 1)) for i in range(3000)]
"""


def start(script):
    text = HEAD + textwrap.dedent(script)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    return subprocess.Popen(
        [sys.executable, "-c", text],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


class Threads(unittest.TestCase):
    def run_quietly(self, script, timeout=120):
        with start(script) as process:
            try:
                output, errors = process.communicate(timeout=timeout)
            except subprocess.TimeoutExpired:
                process.kill()
                raise
        self.assertEqual((process.returncode, errors), (0, ""))
        return output


class Models(Threads):
    def test_of_all_kinds_run_in_threads(self):
        """Oracle: the same calls one after the other."""
        self.run_quietly(
            """
            shape = cv.bend(cilium, contact(1e-3), "beam")
            calls = [
                lambda: solid(0.5e-3),
                lambda: solid(1e-3),
                lambda: shape.B([0, 0, -2e-3], "potential", tolerance=0.05)[0, 0],
                lambda: shape.B([0, 0, -3e-3], "potential", tolerance=0.05)[0, 0],
                lambda: cv.bend(cilium, contact(2e-3), "beam").tip[0],
                lambda: shape.B([[0, 0, -2e-3]] * 500)[-1, 0],
            ]
            with ThreadPoolExecutor(len(calls)) as pool:
                found = list(pool.map(lambda call: call(), calls))
            np.testing.assert_allclose(found, [call() for call in calls], rtol=1e-12)
            """
        )

    def test_that_are_collective_wait_for_each_other_and_others_do_not(self):
        self.run_quietly(
            """
            thread, go_on = begin_solid()
            assert cv.bend(cilium, contact(1e-3), "beam").status == "converged"
            second = threading.Thread(target=solid, args=(2e-3,))
            second.start()
            second.join(0.5)  # it waits without the GIL, which this thread has
            assert second.is_alive()
            go_on.set()
            second.join()
            thread.join()
            """
        )

    def test_run_in_a_function_that_is_told_of_the_progress(self):
        self.run_quietly("solid(1e-3, progress=lambda _, once=[1]: once and (once.clear(), solid(2e-3)))")

    def test_run_in_forked_processes(self):
        """Forked before and after a solid, and in the middle of one."""
        output = self.run_quietly(
            """
            def pool(way, force):
                with multiprocessing.get_context(way).Pool(2) as processes:
                    return processes.map_async(solid, [force] * 2).get(60)
            expected = pool("fork", 1e-3)
            assert solid(1e-3) == expected[0], expected
            thread, go_on = begin_solid()
            assert pool("fork", 1e-3) == expected
            go_on.set()
            thread.join()
            assert pool("fork", 1e-3) == expected
            print("done")
            """
        )
        self.assertEqual(output, "done\n")

    def test_run_in_processes_that_are_not_forked(self):
        with tempfile.TemporaryDirectory() as folder:
            script = Path(folder, "script.py")
            script.write_text(HEAD + textwrap.dedent(
                """
                if __name__ == "__main__":
                    loads = [contact(1e-3)] * 2
                    expected = [cv.bend(cilium, loads[0], "beam").tip[0]] * 2
                    for way in ("spawn", "forkserver"):
                        with multiprocessing.get_context(way).Pool(2) as processes:
                            shapes = processes.starmap(cv.bend, [(cilium, load, "beam") for load in loads])
                            assert [shape.tip[0] for shape in shapes] == expected
                """
            ))  # fmt: skip
            environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
            subprocess.run([sys.executable, script], env=environment, check=True, timeout=120)


class TheEndOfPython(Threads):
    def test_stops_daemon_threads_and_says_nothing(self):
        for call in (
            "cv.bend(cilium, loads, 'solid', progress=told)",
            "cv.bend(cilium, loads, 'beam', progress=told)",
            "(told(0), shape.B(np.random.rand(2000000, 3) + 0.1))",
            "(told(0), shape.B([[0.01, 0.01, 0.01 * i] for i in range(9)], 'potential', tolerance=1e-4))",
            "(told(0), cv.bend_batch([cilium] * 1000000, [contact(1e-3)] * 1000000))",
        ):
            with self.subTest(call):
                begin = time.monotonic()
                self.run_quietly(
                    f"""
                    shape = cv.bend(cilium, contact(1e-3))
                    begun = threading.Event()
                    told = lambda _: begun.set()
                    def work():
                        while True:
                            try:
                                {call}
                            except Exception:
                                pass
                    for _ in range(2):
                        threading.Thread(target=work, daemon=True).start()
                    begun.wait()
                    time.sleep(0.3)
                    """
                )
                self.assertLess(time.monotonic() - begin, 30)

    def test_waits_for_other_threads(self):
        output = self.run_quietly(
            """
            begun = threading.Event()
            work = lambda: print(solid(1e-3, progress=lambda _: begun.set()) > 0)
            threading.Thread(target=work).start()
            begun.wait()
            """
        )
        self.assertEqual(output, "True\n")


class CtrlC(unittest.TestCase):
    def interrupt(self, call, before=""):
        """Sends SIGINT in the middle of a call; returns what the process says, and after how long."""
        with start(f"{before}\nprint('begins', flush=True)\n{call}\n") as process:
            try:
                self.assertEqual(process.stdout.readline(), "begins\n")
                time.sleep(0.7)
                begin = time.monotonic()
                process.send_signal(signal.SIGINT)
                _, errors = process.communicate(timeout=60)
                return errors, time.monotonic() - begin
            finally:
                process.kill()

    def test_ends_a_call_within_two_seconds(self):
        for call, before in [
            ("cv.bend(cilium, loads, 'solid')", ""),
            ("cv.bend(cilium, loads, 'beam')", ""),
            ("cv.bend(cilium, loads * 100)", ""),
            ("shape.B(points)", "points = np.random.rand(3000000, 3) + 0.1"),
            ("shape.B(points, 'line', method='quadrature')", "points = np.random.rand(300000, 3) + 0.1"),
            ("shape.B([[0.01, 0.01, 0.01 * i] for i in range(9)], 'potential', tolerance=1e-5)", ""),
            ("magnet.B(points)", "magnet, points = cuboid(), np.random.rand(3000000, 3)"),
            ("cv.bend_batch([cilium] * 300000, [contact(1e-3)] * 300000, [[0, 0, -1]])", ""),
            ("case.run()", "case = long_case()"),
        ]:
            with self.subTest(call):
                errors, seconds = self.interrupt(call, f"shape = cv.bend(cilium, contact(1e-3))\n{before}")
                self.assertTrue(errors.rstrip().endswith("KeyboardInterrupt"), errors)
                self.assertLess(seconds, 2)

    def test_ends_calls_in_threads(self):
        errors, seconds = self.interrupt(
            """
pool = ThreadPoolExecutor(2)
try:
    [done.result() for done in [pool.submit(cv.bend, cilium, loads, "solid") for _ in range(2)]]
finally:
    pool.shutdown()
"""
        )
        self.assertTrue(errors.rstrip().endswith("KeyboardInterrupt"), errors)
        self.assertLess(seconds, 4)

    def test_leaves_the_models_usable(self):
        errors, _ = self.interrupt(
            """
try:
    cv.bend(cilium, loads, "solid")
except KeyboardInterrupt:
    assert solid(1e-3) > 0
    assert cv.bend(cilium, contact(1e-3)).tip[0] > 0
    sys.stderr.write("usable")
"""
        )
        self.assertEqual(errors, "usable")


if __name__ == "__main__":
    unittest.main()
