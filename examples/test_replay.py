# SPDX-License-Identifier: MIT
"""test_replay.py RECORD REPLAY: what one writes the other plays, whole, in part, cut off, and from a snapshot."""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

RECORD, REPLAY = sys.argv[1:3]
CALLS = {"rg_scene_insert": 21, "rg_scene_move_to": 1000, "rg_scene_set_mask": 50, "rg_scene_remove": 1}


def replay(*arguments):
    """The exit status, the output, and its lines that name calls as {name: number}."""
    done = subprocess.run([REPLAY, *map(str, arguments)], capture_output=True, text=True, check=False)
    calls = {name: int(number) for number, name in re.findall(r"^ +(\d+)  (rg_\w+)$", done.stdout, re.MULTILINE)}
    return done.returncode, done.stdout + done.stderr, calls


def state(output):
    return re.search(r"^state ([0-9a-f]{16})$", output, re.MULTILINE).group(1)


class Replay(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.file = pathlib.Path(cls.folder.name) / "recording"
        subprocess.run([RECORD, cls.file], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_whole(self):
        code, output, calls = replay(self.file)
        self.assertEqual(code, 0, output)
        self.assertEqual(calls, CALLS)
        self.assertIn("1072 calls played\n", output)
        self.assertIn("20 objects, 21 slots, 1 grids\n", output)
        self.assertIn("1 user-defined shapes: boxes stand in for them\n", output)
        self.assertEqual(state(replay("--workers", 2, self.file)[1]), state(output))

    def test_rays(self):
        # Frame 49 has moved ball i to (i + 6.125, 12.25, 5); its radius is 0.5. The box is the sign's.
        code, output, _ = replay(
            "--ray",
            11.125,
            12.25,
            -5,
            0,
            0,
            1,
            "--ray",
            1,
            -1,
            -9,
            0,
            0,
            1,
            "--ray",
            0,
            99,
            0,
            0,
            -1,
            -1e-3,
            self.file,
        )
        self.assertEqual(code, 0, output)
        rays = [line.split(": ")[1] for line in output.splitlines() if line.startswith("ray ")]
        self.assertEqual(rays[0], "object 0x100000006 primitive 0 t 9.5 normal (0, 0, -1)")
        self.assertRegex(rays[1], r"object 0x100000000 primitive 4 t 9 normal \(-?0, -?0, -1\)")
        self.assertEqual(rays[2], "no hit")

    def test_until(self):
        code, output, calls = replay("--until", 24, "--list", self.file)
        self.assertEqual(code, 0, output)
        self.assertEqual(calls, {"rg_scene_insert": 21, "rg_scene_move_to": 3})
        self.assertRegex(output, r"(?m)^ +24  byte +\d+  rg_scene_move_to object 0x100000003$")
        self.assertNotEqual(state(output), state(replay("--until", 50, self.file)[1]))

    def test_cut_off(self):
        part = self.file.with_name("part")
        part.write_bytes(self.file.read_bytes()[:5000])
        code, output, calls = replay(part)
        self.assertEqual(code, 1, output)
        self.assertRegex(output, r"(?m)^it ends here: RG_INVALID_DATA: byte \d+: ")
        self.assertIn(f"{sum(calls.values())} calls played\n", output)
        whole = replay("--until", sum(calls.values()), self.file)
        self.assertEqual(state(output), state(whole[1]))

    def test_snapshot(self):
        saved, again = self.file.with_name("saved"), self.file.with_name("again")
        code, output, _ = replay("--until", 500, "--save", saved, self.file)
        self.assertEqual(code, 0, output)
        code, loaded, calls = replay("--save", again, saved)
        self.assertEqual((code, calls), (0, {}), loaded)
        self.assertEqual(state(loaded), state(output))
        self.assertEqual(again.read_bytes(), saved.read_bytes())

    def test_usage(self):
        for arguments in ([], ["--ray", 1, 2, 3, self.file], ["--until", "x", self.file], [self.file, self.file]):
            with self.subTest(arguments=arguments):
                self.assertEqual(replay(*arguments)[0], 2)
        self.assertEqual(replay(self.file.with_name("none"))[0], 2)
        text = self.file.with_name("text")
        text.write_text("This is no recording.", encoding="ascii")
        code, output, _ = replay(text)
        self.assertEqual(code, 1)
        self.assertIn("no snapshot and no recording", output)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
