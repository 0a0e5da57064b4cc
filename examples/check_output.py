# SPDX-License-Identifier: MIT
"""Runs an example and checks what it prints: check_output.py PATTERN... -- PROGRAM ARGUMENT...

The example must end with 0, and each pattern match a whole line of its output, in the order given.
"""

import re
import subprocess
import sys


def main(arguments):
    split = arguments.index("--")
    patterns, command = arguments[:split], arguments[split + 1 :]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    print(done.stdout, end="")
    lines = iter(done.stdout.splitlines())
    # Each search goes on where the one before stopped, so the order counts.
    missing = [pattern for pattern in patterns if not any(re.fullmatch(pattern, line) for line in lines)]
    if missing:
        print(f"no line matches: {missing[0]}")
    return 1 if missing else done.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
