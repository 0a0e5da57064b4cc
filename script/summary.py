# SPDX-License-Identifier: MIT
"""Adds up the tests of several builds: summary.py ROOT NAME..., for the builds ROOT/build-NAME.

Reads the logs that `meson test` left there, the tests.xml of pytest, or the tests.log of cargo test. A build without a log did not build or did not
run and counts as one failure.
The last line is 'N passed, N failed'; the exit code is 1 if any test failed or none ran.
"""

import json
import pathlib
import sys
import xml.etree.ElementTree

PASSED = {"OK", "EXPECTEDFAIL"}
SKIPPED = {"SKIP", "IGNORED"}


def read_log(path):
    """The (name, result, seconds) of each test in a testlog.json: one JSON object a line."""
    tests = []
    for line in path.read_text(encoding="utf-8").splitlines():
        test = json.loads(line)
        tests.append((test["name"], test["result"], test["duration"]))
    return tests


def read_junit(path):
    """The same of a tests.xml in JUnit's format."""
    tests = []
    for case in xml.etree.ElementTree.parse(path).iter("testcase"):
        bad = case.find("failure") is not None or case.find("error") is not None
        result = "FAIL" if bad else "SKIP" if case.find("skipped") is not None else "OK"
        tests.append((case.get("name"), result, float(case.get("time", 0))))
    return tests


def read_cargo(path):
    """The same of a tests.log: a line for each test, as cargo test prints them; it tells no times."""
    results = {"ok": "OK", "ignored": "SKIP"}
    tests = []
    for line in path.read_text(encoding="utf-8").splitlines():
        name, _, result = line.removeprefix("test ").rpartition(" ... ")
        tests.append((name, results.get(result.split(",")[0], "FAIL"), 0.0))
    return tests


def read_build(build):
    """The tests of a build, by whichever log it has."""
    readers = {"meson-logs/testlog.json": read_log, "tests.xml": read_junit, "tests.log": read_cargo}
    for name, reader in readers.items():
        if (build / name).exists():
            return reader(build / name)
    return []


def main(root, names):
    passed = failed = 0
    failures = []
    print(f"{'build':<8}{'passed':>8}{'failed':>8}{'skipped':>9}{'seconds':>9}")
    for name in names:
        tests = read_build(pathlib.Path(root, f"build-{name}")) or [("no test ran", "ERROR", 0.0)]
        good = sum(result in PASSED for _, result, _ in tests)
        skipped = sum(result in SKIPPED for _, result, _ in tests)
        bad = [(test, result) for test, result, _ in tests if result not in PASSED | SKIPPED]
        seconds = sum(duration for _, _, duration in tests)
        print(f"{name:<8}{good:>8}{len(bad):>8}{skipped:>9}{seconds:>9.1f}")
        passed += good
        failed += len(bad)
        failures += [f"{name}: {test}: {result}" for test, result in bad]
    for line in failures:
        print(line)
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
