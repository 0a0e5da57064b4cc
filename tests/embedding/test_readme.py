# SPDX-License-Identifier: MIT
"""The first C program of the README is examples/hello.c, from its first #include on: test_readme.py SOURCE."""

import pathlib
import re
import sys


def main(source):
    readme = (source / "README.md").read_text(encoding="utf-8")
    hello = (source / "examples" / "hello.c").read_text(encoding="utf-8")
    shown = re.search(r"^```c\n(.*?)^```$", readme, flags=re.M | re.S)
    if not shown:
        print("README.md has no block of C")
        return 1
    if shown.group(1) != hello[hello.index("#include") :]:
        print("the first block of C in README.md is not examples/hello.c from its first #include on")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
