# SPDX-License-Identifier: MIT
"""Puts the library into a source distribution, in place of the link to it.

Like the rest of the distribution, it is what was committed.
"""

import os
import pathlib
import subprocess
import tarfile

LIBRARY = ["LICENSE", "README.md", "include", "lib", "meson.build", "meson_options.txt", "packaging"]


def main() -> None:
    root = subprocess.run(
        ["git", "-C", os.environ["MESON_SOURCE_ROOT"], "rev-parse", "--show-toplevel"],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    ).stdout.rstrip("\n")
    place = pathlib.Path(os.environ["MESON_DIST_ROOT"], "subprojects", "raygrid")
    place.unlink()
    place.mkdir()
    archive = subprocess.Popen(["git", "-C", root, "archive", "HEAD", *LIBRARY], stdout=subprocess.PIPE)
    with tarfile.open(fileobj=archive.stdout, mode="r|") as files:
        files.extractall(place)
    if archive.wait():
        raise SystemExit("git archive failed")
    license_file = pathlib.Path(os.environ["MESON_DIST_ROOT"], "LICENSE")
    license_file.unlink()
    license_file.write_bytes((place / "LICENSE").read_bytes())


main()
