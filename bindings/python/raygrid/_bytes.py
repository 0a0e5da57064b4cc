# SPDX-License-Identifier: MIT
"""Bytes between the library and Python: where snapshots and recordings go, and where they come from."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ._errors import error
from ._raygrid import ffi, lib

Bytes = bytes | bytearray | memoryview


class Writing:
    """A function that gets the bytes that the library writes, and what it raised."""

    def __init__(self, write: Callable[[bytes], object]) -> None:
        self.write = write
        self.raised: BaseException | None = None

    def check(self, result: int) -> None:
        """Raises if `result` is not RG_OK."""
        if self.raised is not None and not isinstance(self.raised, Exception):
            raise self.raised
        if result:
            raise error(result) from self.raised


@ffi.def_extern(error=-1)  # type: ignore[untyped-decorator]
def py_write(user: Any, data: Any, size: int) -> int:
    writing: Writing = ffi.from_handle(user)
    try:
        writing.write(bytes(ffi.buffer(data, size)))
    except BaseException as raised:
        writing.raised = raised
        return -1
    return 0


def sink(handle: Any) -> Any:
    """Where the library writes to, for the handle of a Writing."""
    return ffi.new("rg_sink *", {"size": ffi.sizeof("rg_sink"), "user": handle, "write": lib.py_write})


def source(data: Bytes) -> tuple[Any, Any]:
    """What the library reads from, and what must live as long as it reads."""
    view = ffi.from_buffer(data)
    made = ffi.new("rg_source *", {"size": ffi.sizeof("rg_source"), "bytes": view, "byte_count": len(view)})
    return made, view
