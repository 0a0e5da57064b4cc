# SPDX-License-Identifier: MIT
"""The runner of tests/conformance for Python: plays its cases through the package's own interface."""
