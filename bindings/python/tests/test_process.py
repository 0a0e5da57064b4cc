# SPDX-License-Identifier: MIT
"""The ends of interpreters and processes: with scenes alive, in forks, in subinterpreters; each in its own one."""

from __future__ import annotations

import subprocess
import sys
import textwrap

import pytest


def run(code: str, *, timeout: float = 60) -> str:
    """The output of code in a fresh interpreter, which must end well and say nothing else."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", textwrap.dedent(code)],
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
    )
    assert done.returncode == 0 and not done.stderr, f"exit code {done.returncode}: {done.stderr}"
    return done.stdout


def test_exit_with_live_scenes() -> None:
    run("""
        import numpy as np, raygrid
        keep = [raygrid.Scene(workers=3) for _ in range(3)]
        for scene in keep:
            scene.insert(raygrid.Sphere(), np.random.default_rng(1).normal(size=(100, 3)))
            scene.trace(np.zeros((5000, 3)), (0, 0, 1))
    """)


def test_exit_with_a_scene_in_a_cycle_and_in_a_callback() -> None:
    run("""
        import raygrid
        class Holder: pass
        holder = Holder()
        holder.scene = raygrid.Scene(log=lambda line: holder)
        holder.self = holder
        holder.scene.insert(raygrid.Sphere())
    """)


def test_exit_with_arrays_that_meshes_read() -> None:
    run("""
        import numpy as np, raygrid
        corners = np.random.default_rng(3).normal(size=(300, 3))
        keep = [raygrid.Mesh(corners, borrow=True) for _ in range(3)]
        scene = raygrid.Scene(workers=2)
        scene.insert(keep)
        scene.trace(corners, -corners)
    """)


def test_exit_while_another_thread_traces() -> None:
    run("""
        import threading, time
        import numpy as np, raygrid
        random = np.random.default_rng(2)
        scene = raygrid.Scene(workers=2)
        scene.insert(raygrid.Sphere(), random.normal(size=(5000, 3)) * 30)
        rays = random.normal(size=(200000, 3)), random.normal(size=(200000, 3))
        started = threading.Event()
        def forever():
            while True:
                started.set()
                scene.trace(*rays)
        threading.Thread(target=forever, daemon=True).start()
        started.wait()
        time.sleep(0.05)
    """)


def test_fork() -> None:
    output = run("""
        import os, sys, warnings
        warnings.simplefilter("ignore", DeprecationWarning)
        import raygrid
        scene = raygrid.Scene(workers=3)
        scene.insert(raygrid.Sphere(), (0, 0, 5))
        child = os.fork()
        if not child:
            try:
                scene.trace((0, 0, 0), (0, 0, 1))
            except ValueError as error:
                print(error, flush=True)
            del scene
            with raygrid.Scene(workers=2) as own:
                own.insert(raygrid.Sphere(), (0, 0, 7))
                print(own.trace((0, 0, 0), (0, 0, 1)).t.tolist(), flush=True)
            sys.exit(0)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
        print(scene.trace((0, 0, 0), (0, 0, 1)).t.tolist())
    """)
    assert output.splitlines() == [
        "the scene belongs to the parent process: make one in this process",
        "[6.0]",
        "[4.0]",
    ]


SUBINTERPRETER = """
    import {module} as interpreters
    code = '''if 1:
        try:
            import raygrid
        except ImportError as error:
            print("refused", type(error).__name__)
        else:
            with raygrid.Scene() as scene:
                scene.insert(raygrid.Sphere(), (0, 0, 5))
                print("works", scene.trace((0, 0, 0), (0, 0, 1)).t.tolist())
    '''
    one = interpreters.create()
    failed = interpreters.{run}
    if failed:
        print(failed)
    interpreters.destroy(one)
"""


@pytest.mark.skipif(sys.version_info < (3, 12), reason="before 3.12 subinterpreters share all of the interpreter")
def test_a_subinterpreter_is_refused_or_works() -> None:
    module, call = (
        ("_interpreters", "exec(one, code)")
        if sys.version_info >= (3, 13)
        else ("_xxsubinterpreters", "run_string(one, code)")
    )
    assert run(SUBINTERPRETER.format(module=module, run=call)) in ("refused ImportError\n", "works [4.0]\n")
