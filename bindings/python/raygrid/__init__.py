# SPDX-License-Identifier: MIT
"""Ray queries in scenes where everything may appear, move and vanish at any moment.

>>> import raygrid
>>> with raygrid.Scene() as scene:
...     balls = scene.insert(raygrid.Sphere(1), [[0, 0, 5], [0, 0, 9]])
...     scene.remove(balls[0])
...     hits = scene.trace((0, 0, 0), (0, 0, 1))
>>> hits.t, hits.object == balls[1]
(array([8.]), array([ True]))

Lengths are in one unit, the caller's. Coordinates are float64 in the library; arrays may be float32. Docstrings give
shapes as (N, 3): N records of three numbers, x, y, z.
"""

from ._errors import (
    Busy,
    CallbackFailed,
    Error,
    InvalidArgument,
    InvalidData,
    InvalidId,
    InvalidValue,
    LimitExceeded,
    OutOfMemory,
    OutOfThreads,
)
from ._grids import REBUILD_NEVER, Grid, GridConfig, GridKind, GridReport
from ._hits import Hits
from ._raygrid import lib as _lib
from ._replay import Call, Replay, Step
from ._scene import Candidate, Cull, Frame, Isa, ObjectReport, Scene, SceneReport, Without
from ._shapes import Box, Capsule, Mesh, MeshQuality, Shape, Sphere

__version__ = "{}.{}.{}".format(*(_lib.rg_version() // 1000**place % 1000 for place in (2, 1, 0)))

NO_OBJECT: int = _lib.RG_NO_OBJECT
NO_PRIMITIVE: int = _lib.RG_NO_PRIMITIVE
COORDINATE_MAX: float = _lib.RG_COORDINATE_MAX
RADIUS_MIN: float = _lib.RG_RADIUS_MIN

__all__ = [
    "Box",
    "Busy",
    "COORDINATE_MAX",
    "Call",
    "CallbackFailed",
    "Candidate",
    "Capsule",
    "Cull",
    "Error",
    "Frame",
    "Grid",
    "GridConfig",
    "GridKind",
    "GridReport",
    "Hits",
    "InvalidArgument",
    "InvalidData",
    "InvalidId",
    "InvalidValue",
    "Isa",
    "LimitExceeded",
    "Mesh",
    "MeshQuality",
    "NO_OBJECT",
    "NO_PRIMITIVE",
    "ObjectReport",
    "OutOfMemory",
    "OutOfThreads",
    "RADIUS_MIN",
    "REBUILD_NEVER",
    "Replay",
    "Scene",
    "SceneReport",
    "Shape",
    "Sphere",
    "Step",
    "Without",
]

# Users see the names that they import.
for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = __name__
del _name
